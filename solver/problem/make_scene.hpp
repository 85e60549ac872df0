#pragma once

#include "problem/case.hpp"
#include "problem/scene.hpp"

namespace sandglass {

/// A case with its mesh before refinement, and the sets of that mesh.
struct CaseOnMesh {
  Case description;
  Mesh mesh;
  NodeSets sets = {};
  ElementSets element_sets = {};
};

/// Resolves sets, materials, imposed displacements and rotations, forces and initial velocities. Throws
/// InputError for an inverted element, an empty set, an element with no material or two, a node with two
/// different paths, a load on a set without boundary faces, and a wave along an axis on which its set has no
/// extent.
Scene make_scene(const CaseOnMesh& on_mesh);

/// The same for a case and a mesh with sets.
Scene make_scene(const Case& description, Mesh mesh, NodeSets sets_of_file = {},
                 ElementSets element_sets_of_file = {});

/// The mesh of a case that names a generator.
Mesh generate_mesh(const AnyGenerator& generator);

}  // namespace sandglass
