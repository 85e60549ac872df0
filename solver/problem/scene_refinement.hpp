#pragma once

#include "mesh/refinement.hpp"
#include "problem/case.hpp"

namespace sandglass {

/// The case with some elements of its refined mesh split once more, by their numbers. Nodes keep theirs.
Case refined(Case description, std::vector<int> elements);

/// A nodal field of the mesh before the last split, on the mesh after it: the same trilinear field.
NodalField prolonged(const CoarserMesh& coarser, NodalField u);

}  // namespace sandglass
