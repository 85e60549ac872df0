#pragma once

#include <string>

#include "problem/model.hpp"

namespace sandglass {

/// Whether a method does not resist hourglass modes, so that a mesh of it has mechanisms.
bool leaves_hourglass_modes(const MethodChoice& choice);

/// Why the eigenvalues of the tangent do not decide whether an equilibrium of the model is stable; empty if
/// they do. `depends_on_path`: whether element forces depend on the path.
std::string why_not_decided(const Model& model, bool depends_on_path);

}  // namespace sandglass
