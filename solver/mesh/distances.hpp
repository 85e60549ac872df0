#pragma once

#include <vector>

#include "mesh/node_elements.hpp"

namespace sandglass {

/// Distances between the nodes of a mesh: the number of elements to cross, from corner to corner.
class Distances {
 public:
  explicit Distances(const Mesh& mesh) : mesh_(mesh), elements_(mesh) {}

  /// The distance of each node from the nearest of `nodes`; -1 if elements do not connect them.
  std::vector<int> from(const std::vector<int>& nodes) const;

  /// Marks the elements that lie within margin[node] of a node; a margin of 0 marks none.
  void mark(std::vector<int> margin, std::vector<bool>& marked) const;

 private:
  template <class Visit>
  void for_neighbours(int node, const Visit& visit) const;

  const Mesh& mesh_;
  NodeElements elements_;
};

}  // namespace sandglass
