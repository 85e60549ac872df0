#include "mesh/mesh.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/error.hpp"

namespace sandglass {

double largest_distance(const NodalField& a, const NodalField& b) {
  double largest = 0.0;
  for (std::size_t n = 0; n < a.size(); ++n) {
    const double d = distance(a[n], b[n]);
    if (std::isnan(d)) return d;
    largest = std::max(largest, d);
  }
  return largest;
}

std::vector<Quadrilateral> boundary_faces(std::span<const Hexahedron> cells) {
  std::vector<Quadrilateral> faces, keys;  // keys have their nodes in ascending order
  int last = -1;
  for (const auto& cell : cells) {
    for (const auto& local : hexahedron_faces) {
      faces.push_back({cell[local[0]], cell[local[1]], cell[local[2]], cell[local[3]]});
      keys.push_back(faces.back());
      std::sort(keys.back().begin(), keys.back().end());
      last = std::max(last, keys.back()[0]);
    }
  }
  std::vector<std::vector<std::size_t>> by_first_node(at(last + 1));
  for (std::size_t f = 0; f < keys.size(); ++f) by_first_node[at(keys[f][0])].push_back(f);
  std::vector<Quadrilateral> boundary;
  for (std::size_t f = 0; f < keys.size(); ++f) {
    const auto& near = by_first_node[at(keys[f][0])];
    std::size_t count = 0;
    for (const std::size_t other : near) {
      if (keys[other] != keys[f]) continue;
      ++count;
      // Elements on opposite sides of a face list its nodes in opposite directions.
      const Quadrilateral& facing = faces[other];
      const auto first = static_cast<std::size_t>(std::ranges::find(facing, faces[f][0]) - facing.begin());
      if (other == f || facing[(first + 1) % 4] != faces[f][1]) continue;
      throw InputError(fmt::format(
          "elements {} and {} lie on the same side of their common face, or share it with a third; elements "
          "must not overlap",
          f / hexahedron_faces.size(), other / hexahedron_faces.size()));
    }
    if (count == 1) boundary.push_back(faces[f]);
  }
  return boundary;
}

std::vector<bool> nodes_of(const std::vector<Quadrilateral>& faces, std::size_t nodes) {
  std::vector<bool> on_faces(nodes, false);
  for (const auto& face : faces) {
    for (const int node : face) on_faces[at(node)] = true;
  }
  return on_faces;
}

std::vector<bool> boundary_nodes(const Mesh& mesh) {
  return nodes_of(boundary_faces(mesh.cells), mesh.points.size());
}

std::array<Vector, 2> bounding_box(const NodalField& points) {
  constexpr double inf = std::numeric_limits<double>::infinity();
  std::array<Vector, 2> box{Vector{inf, inf, inf}, Vector{-inf, -inf, -inf}};
  for (const auto& point : points) {
    for (std::size_t i = 0; i < 3; ++i) {
      box[0][i] = std::min(box[0][i], point[i]);
      box[1][i] = std::max(box[1][i], point[i]);
    }
  }
  return box;
}

double diagonal(const NodalField& points) {
  const auto [low, high] = bounding_box(points);
  return std::hypot(high[0] - low[0], high[1] - low[1], high[2] - low[2]);
}

}  // namespace sandglass
