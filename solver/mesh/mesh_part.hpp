#pragma once

#include <vector>

#include "mesh/mesh.hpp"

namespace sandglass {

/// Some elements of a mesh as a mesh of their own. Nodes and elements keep their order.
struct MeshPart {
  Mesh mesh;
  std::vector<int> node_of;      ///< the whole mesh's number of each node of the part
  std::vector<int> element_of;   ///< and of each element
  std::vector<int> part_of;      ///< the part's number of each node of the whole; -1: not in it
  std::vector<bool> on_the_rim;  ///< which nodes of the part belong to elements outside of it, too
};

/// The elements that are marked.
MeshPart part_of_mesh(const Mesh& mesh, const std::vector<bool>& marked);

}  // namespace sandglass
