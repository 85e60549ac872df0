#pragma once

#include "mesh/refinement.hpp"
#include "problem/case.hpp"

namespace sandglass {

/// The case with some elements of its refined mesh, given by number, split once more. Nodes keep their
/// numbers.
Case refined(Case description, std::vector<int> elements);

/// A nodal field of the mesh before the last split, interpolated trilinearly on the mesh after it.
NodalField prolonged(const CoarserMesh& coarser, NodalField u);

}  // namespace sandglass
