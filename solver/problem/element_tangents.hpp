#pragma once

#include <functional>
#include <span>

#include "math/dual.hpp"
#include "problem/model.hpp"

namespace sandglass {

/// The forces (N) of one element on its nodes, with their derivatives (N) along a motion as slopes.
using ElementSlopes = NodalVectors<Dual<double>>;

/// Calls visit(e, forces) for each element of a model in static equilibrium at displacements u (m), and a
/// motion (m): the method's own kernel in dual numbers, so that slopes are exact. `materials` are the
/// model's, whose parameters may differ; `levels` those of an adaptive method, else empty. Throws InputError
/// if forces depend on the path.
void for_each_element_slope(const Model& model, const Materials& materials, std::span<const double> levels,
                            const NodalField& u, const NodalField& motion,
                            const std::function<void(std::size_t, const ElementSlopes&)>& visit);

/// Calls visit(e, derivatives) for each element with the derivatives (N) of v . f by the reference positions
/// of its nodes, f its forces (N) in static equilibrium at displacements u (m): central differences over 1e-4
/// of its shortest edge, whose error is about 1e-8. Axes of materials count as constant. Throws InputError
/// like `for_each_element_slope`, and for methods whose elements average over nodes.
void for_each_shape_derivative(const Model& model, std::span<const double> levels, const NodalField& u,
                               const NodalField& v,
                               const std::function<void(std::size_t, const NodalVectors<double>&)>& visit);

}  // namespace sandglass
