#pragma once

#include <span>
#include <vector>

#include "mesh/mesh.hpp"

namespace sandglass {

/// The elements around each node of a mesh.
class NodeElements {
 public:
  explicit NodeElements(const Mesh& mesh);

  /// The elements around a node, in ascending order.
  std::span<const int> around(int node) const;

 private:
  std::vector<std::size_t> first_;
  std::vector<int> elements_;
};

}  // namespace sandglass
