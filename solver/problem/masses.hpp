#pragma once

#include <vector>

#include "material/materials.hpp"
#include "mesh/mesh.hpp"

namespace sandglass {

/// Mass of each element, kg.
std::vector<double> element_masses(const Mesh& mesh, const Materials& materials);

/// Lumped masses of the nodes (kg): an eighth of each element's mass at each of its nodes, and what is
/// attached to them (kg; empty: nothing).
std::vector<double> lumped_masses(const Mesh& mesh, const std::vector<double>& element_masses,
                                  std::vector<double> attached = {});

}  // namespace sandglass
