#include "multigrid/grid.hpp"

#include <algorithm>
#include <cmath>

namespace sandglass {

Vector extent(const Mesh& mesh, const Hexahedron& cell) {
  const auto [low, high] = bounding_box(values_at(cell, mesh.points));
  return {high[0] - low[0], high[1] - low[1], high[2] - low[2]};
}

Grid Grid::around(const Mesh& mesh) {
  const auto [low, high] = bounding_box(mesh.points);
  Vector mean{};
  for (const auto& cell : mesh.cells) {
    const Vector own = extent(mesh, cell);
    for (std::size_t i = 0; i < 3; ++i) mean[i] += own[i] / static_cast<double>(mesh.cells.size());
  }
  const double narrowest = *std::min_element(mean.begin(), mean.end());
  Grid grid;
  grid.low = low;
  for (std::size_t i = 0; i < 3; ++i) {
    const double width = std::max(mean[i], 2.0 * narrowest);
    grid.boxes[i] = static_cast<std::size_t>(std::max(1.0, std::round((high[i] - low[i]) / width)));
    grid.size[i] = (high[i] - low[i]) / static_cast<double>(grid.boxes[i]);
  }
  return grid;
}

Grid Grid::coarser(std::array<bool, 3>& halved) const {
  double narrowest = INFINITY;
  for (std::size_t i = 0; i < 3; ++i) {
    if (boxes[i] > 1) narrowest = std::min(narrowest, size[i]);
  }
  Grid grid = *this;
  for (std::size_t i = 0; i < 3; ++i) {
    halved[i] = boxes[i] > 1 && size[i] < 1.5 * narrowest;
    if (!halved[i]) continue;
    grid.boxes[i] = (boxes[i] + 1) / 2;
    grid.size[i] = 2.0 * size[i];
  }
  return grid;
}

Grid::Location Grid::locate(const Vector& point) const {
  Location location{0, {}};
  std::array<std::size_t, 3> at{};
  for (std::size_t i = 0; i < 3; ++i) {
    const double x = (point[i] - low[i]) / size[i];
    const double box = std::clamp(std::floor(x), 0.0, static_cast<double>(boxes[i]) - 1.0);
    at[i] = static_cast<std::size_t>(box);
    location.local[i] = static_cast<float>(x - box);
  }
  location.box = number(at[0], at[1], at[2]);
  return location;
}

std::array<float, 8> weights(const std::array<float, 3>& local) {
  std::array<float, 8> w;
  for (std::size_t c = 0; c < 8; ++c) {
    w[c] = 1.0f;
    for (std::size_t i = 0; i < 3; ++i) w[c] *= (c >> i & 1) != 0 ? local[i] : 1.0f - local[i];
  }
  return w;
}

}  // namespace sandglass
