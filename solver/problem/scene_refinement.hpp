#pragma once

#include "problem/make_scene.hpp"

namespace sandglass {

/// Refines the mesh of a scene, which has its sets, boundary and materials, as a case wants it: sets and
/// materials pass on to the parts of elements, and nodes that hang are tied. Throws InputError for a set that
/// is not there, is empty, or has no edge.
void refine(const Case& description, Scene& scene);

/// The case with some elements of its refined mesh split once more, by their numbers. Nodes keep theirs.
Case refined(Case description, std::vector<int> elements);

/// A nodal field of the mesh before the last split, on the mesh after it: the same trilinear field.
NodalField prolonged(const CoarserMesh& coarser, NodalField u);

}  // namespace sandglass
