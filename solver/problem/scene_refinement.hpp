#pragma once

#include "problem/scene.hpp"

namespace sandglass {

/// Refines the mesh of a scene, which has its sets, boundary and materials, as its case wants it: sets and
/// materials pass on to the parts of elements, and nodes that hang are tied. Throws InputError for a set that
/// is not there, is empty, or has no edge.
void refine(Scene& scene);

/// The scene of another description on the original, unrefined mesh of a scene, whose sets it has. Throws as
/// `make_scene` does.
Scene remade(const Scene& scene, Case description);

/// The scene with some of its elements split once more, by their numbers. Its description says so. Original
/// nodes keep their numbers.
Scene refined(const Scene& scene, std::vector<int> elements);

/// A nodal field of the mesh before the last split, on the mesh after it: the same trilinear field.
NodalField prolonged(const CoarserMesh& coarser, NodalField u);

}  // namespace sandglass
