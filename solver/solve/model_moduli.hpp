#pragma once

#include <vector>

#include "multigrid/element_level.hpp"
#include "problem/model.hpp"

namespace sandglass {

/// The moduli with which the multigrid method models each material: those of the undeformed law, and of the
/// method's control against hourglass modes.
std::vector<ModelModuli> model_moduli(const Model& model);

}  // namespace sandglass
