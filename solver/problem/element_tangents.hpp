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

}  // namespace sandglass
