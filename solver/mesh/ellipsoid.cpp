#include "mesh/ellipsoid.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "mesh/bulge.hpp"
#include "mesh/lattice.hpp"
#include "mesh/vectors.hpp"

namespace sandglass {

namespace {

/// The map of the unit ball onto itself that keeps angles (Moebius) and moves the centre to f.
Vector refocused(const Vector& x, const Vector& f) {
  const double xx = dot(x, x), fx = dot(f, x), ff = dot(f, f), scale = 1.0 + 2.0 * fx + ff * xx;
  return sum(sum({}, (1.0 - ff) / scale, x), (1.0 + 2.0 * fx + xx) / scale, f);
}

}  // namespace

std::optional<BrokenRule> EllipsoidMesh::broken_rule() const {
  if (length(focus) < 1.0) return std::nullopt;
  return BrokenRule{"focus", fmt::format("= {} must be in the unit ball", focus)};
}

Mesh EllipsoidMesh::build() const {
  NodalField directions;
  Mesh mesh = lattice({core_elements, core_elements, core_elements}, [&](const Vector& s) {
    const Bulge<3> cube{{2.0 * s[0] - 1.0, 2.0 * s[1] - 1.0, 2.0 * s[2] - 1.0}};
    directions.push_back(cube.direction());
    return cube.core_point(core_size, core_bulge);
  });

  // Every node on the core's surface is joined to the unit sphere by equal layers.
  const auto faces = boundary_faces(mesh.cells);
  const auto on_surface = nodes_of(faces, mesh.points.size());
  const auto core_nodes = mesh.points.size();
  std::vector<int> below(core_nodes);  // the node under the layer being built, per core surface node
  for (std::size_t n = 0; n < core_nodes; ++n) below[n] = static_cast<int>(n);
  for (int layer = 1; layer <= shell_layers; ++layer) {
    const double s = static_cast<double>(layer) / shell_layers;
    std::vector<int> above(core_nodes, -1);
    for (std::size_t n = 0; n < core_nodes; ++n) {
      if (!on_surface[n]) continue;
      Vector point{};
      for (std::size_t i = 0; i < 3; ++i) point[i] = (1.0 - s) * mesh.points[n][i] + s * directions[n][i];
      above[n] = static_cast<int>(mesh.points.size());
      mesh.points.push_back(point);
    }
    for (const auto& face : faces) {
      Hexahedron cell{};
      for (std::size_t c = 0; c < 4; ++c) {
        cell[c] = below[at(face[c])];
        cell[c + 4] = above[at(face[c])];
      }
      mesh.cells.push_back(cell);
    }
    below = above;
  }

  for (auto& point : mesh.points) {
    if (focus != Vector{}) point = refocused(point, focus);
    for (std::size_t i = 0; i < 3; ++i) point[i] *= semi_axes[i];
  }
  return mesh;
}

}  // namespace sandglass
