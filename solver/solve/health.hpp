#pragma once

#include <span>
#include <string_view>

#include "solve/body.hpp"

namespace sandglass {

/// Whether det F is positive and finite.
bool is_healthy(double jacobian);

/// Whether all displacements of a body are finite and no element is inverted.
template <class Real>
bool is_healthy(const Body<Real>& body);

/// Whether all displacements of a body are finite, which costs much less.
template <class Real>
bool is_finite(const Body<Real>& body);

/// Throws ComputationError if an element is inverted or its det F is not finite; the error names the step,
/// the first ten such elements with det F, and a remedy. `jacobians` are the smallest det F of each element.
void require_healthy(std::span<const double> jacobians, long step);

/// The same for the elements of a body.
template <class Real>
void require_healthy(const Body<Real>& body, long step);

/// Throws ComputationError if a node may have passed through a surface; the error names the moment and its
/// value, as in "step 100" or "load 0.5".
void require_not_passed(const Touch& touch, const NodalField& points, std::string_view moment, double value);

/// Throws InputError if a contact is supported in motions only, or if friction would follow a curve in levels
/// that the user has not chosen.
void require_static_contact(const Scene& scene);

/// Throws ComputationError if a surface that may touch lies deep inside another element at displacements u
/// (m), but did not at the start: a search for equilibrium may pass bodies through each other.
void require_apart(const Scene& scene, const NodalField& u);

}  // namespace sandglass
