#include "mesh/distances.hpp"

#include <algorithm>

namespace sandglass {

/// Calls visit(n) for the nodes that share an element with a node, including itself, some more than once.
template <class Visit>
void Distances::for_neighbours(int node, const Visit& visit) const {
  for (const int e : elements_.around(node)) {
    for (const int other : mesh_.cells[at(e)]) visit(other);
  }
}

std::vector<int> Distances::from(const std::vector<int>& nodes) const {
  std::vector<int> distance(mesh_.points.size(), -1);
  std::vector<int> reached = nodes;
  for (const int node : nodes) distance[at(node)] = 0;
  for (std::size_t k = 0; k < reached.size(); ++k) {
    const int next = distance[at(reached[k])] + 1;
    for_neighbours(reached[k], [&](int node) {
      if (distance[at(node)] >= 0) return;
      distance[at(node)] = next;
      reached.push_back(node);
    });
  }
  return distance;
}

void Distances::mark(std::vector<int> margin, std::vector<bool>& marked) const {
  const int most = margin.empty() ? 0 : *std::max_element(margin.begin(), margin.end());
  std::vector<std::vector<int>> nodes_of(at(most) + 1);
  for (std::size_t n = 0; n < margin.size(); ++n) nodes_of[at(margin[n])].push_back(static_cast<int>(n));
  for (int left = most; left > 0; --left) {
    for (const int node : nodes_of[at(left)]) {
      if (margin[at(node)] != left) continue;  // it has a larger margin by now
      for (const int e : elements_.around(node)) marked[at(e)] = true;
      for_neighbours(node, [&](int other) {
        if (margin[at(other)] >= left - 1) return;
        margin[at(other)] = left - 1;
        nodes_of[at(left - 1)].push_back(other);
      });
    }
  }
}

}  // namespace sandglass
