#pragma once

#include <algorithm>

#include "mesh/mesh.hpp"

namespace sandglass {

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
