#include "mesh/cylinder.hpp"

#include "mesh/bulge.hpp"

namespace sandglass {

namespace {

using Point2 = std::array<double, 2>;

/// A plane grid of quadrilaterals, counterclockwise.
struct OGrid {
  std::vector<Point2> points;
  std::vector<Quadrilateral> cells;
};

/// The unit disc: core of n x n quadrilaterals and rings around it.
OGrid unit_disc(int n, int rings, double core_size, double core_bulge) {
  OGrid grid;
  std::vector<Point2> directions;
  for (int j = 0; j <= n; ++j) {
    for (int i = 0; i <= n; ++i) {
      const Bulge<2> square{{2.0 * i / n - 1.0, 2.0 * j / n - 1.0}};
      grid.points.push_back(square.core_point(core_size, core_bulge));
      directions.push_back(square.direction());
    }
  }
  const auto node = [n](int i, int j) { return i + (n + 1) * j; };
  for (int j = 0; j < n; ++j) {
    for (int i = 0; i < n; ++i) {
      grid.cells.push_back({node(i, j), node(i + 1, j), node(i + 1, j + 1), node(i, j + 1)});
    }
  }

  std::vector<int> loop;  // the core's outline, counterclockwise
  for (int i = 0; i < n; ++i) loop.push_back(node(i, 0));
  for (int j = 0; j < n; ++j) loop.push_back(node(n, j));
  for (int i = n; i > 0; --i) loop.push_back(node(i, n));
  for (int j = n; j > 0; --j) loop.push_back(node(0, j));

  std::vector<int> inner = loop;
  for (int ring = 1; ring <= rings; ++ring) {
    const double s = static_cast<double>(ring) / rings;
    std::vector<int> outer;
    for (const int core_node : loop) {
      const auto c = at(core_node);
      outer.push_back(static_cast<int>(grid.points.size()));
      grid.points.push_back({(1.0 - s) * grid.points[c][0] + s * directions[c][0],
                             (1.0 - s) * grid.points[c][1] + s * directions[c][1]});
    }
    for (std::size_t a = 0; a < loop.size(); ++a) {
      const std::size_t b = (a + 1) % loop.size();
      grid.cells.push_back({inner[a], outer[a], outer[b], inner[b]});
    }
    inner = outer;
  }
  return grid;
}

}  // namespace

Mesh CylinderMesh::build() const {
  const OGrid grid = unit_disc(core_elements, rings, core_size, core_bulge);
  const int plane = static_cast<int>(grid.points.size());
  Mesh mesh;
  for (int k = 0; k <= layers; ++k) {
    for (const auto& point : grid.points) {
      mesh.points.push_back({radius * point[0], radius * point[1], height * k / layers});
    }
  }
  for (int k = 0; k < layers; ++k) {
    for (const auto& [a, b, c, d] : grid.cells) {
      const int low = k * plane;
      const int high = low + plane;
      mesh.cells.push_back({low + a, low + b, low + c, low + d, high + a, high + b, high + c, high + d});
    }
  }
  return mesh;
}

}  // namespace sandglass
