#include "comparison/mesh_quality.hpp"

#include <algorithm>
#include <cmath>

#include "mesh/hexahedron.hpp"

namespace sandglass {

double scaled_jacobian(const NodalVectors<double>& X) {
  double smallest = 1.0;
  for (int corner = 0; corner < corner_signs.rows; ++corner) {
    const std::array<double, 3> at{corner_signs(corner, 0), corner_signs(corner, 1), corner_signs(corner, 2)};
    Tensor<double> edges = parent_jacobian(X, at);  // columns: half edge vectors at the corner
    for (int j = 0; j < 3; ++j) {
      const double length = std::hypot(edges(0, j), edges(1, j), edges(2, j));
      for (int i = 0; i < 3; ++i) edges(i, j) /= length;
    }
    smallest = std::min(smallest, determinant(edges));
  }
  return smallest;
}

QualityTable quality_table(const Mesh& mesh) {
  QualityTable table;
  for (std::size_t e = 0; e < mesh.cells.size(); ++e) {
    const auto X = gather(mesh.points, mesh.cells[e]);
    const double quality = scaled_jacobian(X);
    table.smallest = std::min(table.smallest, quality);
    table.largest = std::max(table.largest, quality);
    const double tenth = std::clamp(std::ceil(10.0 * quality), 0.0, 10.0);
    ++table.counts[static_cast<std::size_t>(tenth)];
    table.worst.push_back({e, quality, mean_at(mesh.cells[e], mesh.points)});
  }
  const auto end = table.worst.begin() + static_cast<long>(std::min<std::size_t>(10, table.worst.size()));
  std::partial_sort(table.worst.begin(), end, table.worst.end(), [](const auto& a, const auto& b) {
    return std::pair(a.scaled_jacobian, a.number) < std::pair(b.scaled_jacobian, b.number);
  });
  table.worst.erase(end, table.worst.end());
  return table;
}

}  // namespace sandglass
