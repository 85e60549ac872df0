#include "mesh/parts.hpp"

#include <algorithm>

#include "mesh/disjoint_sets.hpp"

namespace sandglass {

std::vector<int> parts_of_nodes(const Mesh& mesh, const Ties& ties) {
  DisjointSets joined(mesh.points.size());
  std::vector<bool> used(mesh.points.size());
  for (const auto& cell : mesh.cells) {
    for (const int node : cell) {
      joined.join(cell.front(), node);
      used[at(node)] = true;
    }
  }
  for (const Tie& tie : ties) {
    for (const auto& share : tie.mean_of) joined.join(tie.node, share.node);
  }
  std::vector<int> part(mesh.points.size(), -1), number(mesh.points.size(), -1);
  int parts = 0;
  for (std::size_t n = 0; n < part.size(); ++n) {
    if (!used[n]) continue;
    int& own = number[at(joined.least(static_cast<int>(n)))];
    if (own < 0) own = parts++;
    part[n] = own;
  }
  return part;
}

int number_of_parts(const Mesh& mesh, const Ties& ties) {
  const std::vector<int> parts = parts_of_nodes(mesh, ties);
  return parts.empty() ? 0 : 1 + *std::max_element(parts.begin(), parts.end());
}

}  // namespace sandglass
