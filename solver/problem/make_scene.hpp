#pragma once

#include "problem/case.hpp"
#include "problem/scene.hpp"

namespace sandglass {

/// A case, and the mesh that it begins with and may refine, with the sets that came with it.
struct CaseOnMesh {
  Case description;
  Mesh mesh;
  NodeSets sets = {};
  ElementSets element_sets = {};
};

/// Sets by their rules, materials of the elements, constraints from the imposed displacements and rotations,
/// forces, initial velocities. Throws InputError for an inverted element, an empty
/// set, an element that has no material or two, a node to which two different paths are imposed, a load on a
/// set without boundary faces, and a wave along an axis on which its set has no extent.
Scene make_scene(const CaseOnMesh& on_mesh);

/// The same of a case and a mesh with sets.
Scene make_scene(const Case& description, Mesh mesh, NodeSets sets_of_file = {},
                 ElementSets element_sets_of_file = {});

/// The mesh of a case whose mesh comes from a generator.
Mesh generate_mesh(const AnyGenerator& generator);

}  // namespace sandglass
