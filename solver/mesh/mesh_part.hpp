#pragma once

#include <vector>

#include "mesh/mesh.hpp"

namespace sandglass {

/// A subset of the elements of a mesh as a separate mesh. Nodes and elements keep their order.
struct MeshPart {
  Mesh mesh;
  std::vector<int> node_of;      ///< number in the whole mesh of each node of the part
  std::vector<int> element_of;   ///< number in the whole mesh of each element of the part
  std::vector<int> part_of;      ///< number in the part of each node of the whole; -1 if not in the part
  std::vector<bool> on_the_rim;  ///< whether each node of the part also belongs to an element outside it
};

/// The part that consists of the marked elements.
MeshPart part_of_mesh(const Mesh& mesh, const std::vector<bool>& marked);

}  // namespace sandglass
