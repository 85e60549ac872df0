#pragma once

#include "mesh/mesh.hpp"

namespace sandglass {

/// A mesh and its sets.
struct MeshWithSets {
  Mesh mesh;
  NodeSets sets = {};
  ElementSets element_sets = {};
};

}  // namespace sandglass
