#pragma once

#include <algorithm>

#include "mesh/mesh.hpp"

namespace sandglass {

/// The ends of the edges of a hexahedron, by its corners.
inline constexpr std::array<std::array<std::size_t, 2>, 12> hexahedron_edges{
    {{0, 1}, {1, 2}, {2, 3}, {3, 0}, {4, 5}, {5, 6}, {6, 7}, {7, 4}, {0, 4}, {1, 5}, {2, 6}, {3, 7}}};

/// The length of the shortest edge of all elements, m.
inline double shortest_edge(const Mesh& mesh) {
  double shortest = INFINITY;
  for (const Hexahedron& cell : mesh.cells) {
    for (const auto& [a, b] : hexahedron_edges)
      shortest = std::min(shortest, distance(mesh.points[at(cell[a])], mesh.points[at(cell[b])]));
  }
  return shortest;
}

}  // namespace sandglass
