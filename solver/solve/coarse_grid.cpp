#include "solve/coarse_grid.hpp"

#include <algorithm>

namespace sandglass {

CoarseGrid::CoarseGrid(const NodalField& points) {
  const auto [low, high] = bounding_box(points);
  low_ = low;
  const std::size_t most =
      std::clamp<std::size_t>(points.size() / 100, std::clamp<std::size_t>(points.size() / 8, 8, 64), 125);
  for (;;) {
    for (std::size_t i = 0; i < 3; ++i) size_[i] = (high[i] - low[i]) / counts_[i];
    const double largest = *std::max_element(size_.begin(), size_.end());
    const std::array<int, 3> before = counts_;
    for (std::size_t i = 0; i < 3; ++i) counts_[i] += size_[i] >= 0.75 * largest ? 1 : 0;
    if (nodes() <= most) continue;
    counts_ = before;
    return;
  }
}

CoarseGrid::Location CoarseGrid::locate(const Vector& point) const {
  Location location{0, {}};
  for (std::size_t i = 3; i-- > 0;) {
    const double x = (point[i] - low_[i]) / size_[i];
    const int whole = std::clamp(static_cast<int>(x), 0, counts_[i] - 1);
    location.box = location.box * count(i) + static_cast<std::size_t>(whole);
    location.local[i] = x - whole;
  }
  return location;
}

std::array<std::size_t, 8> CoarseGrid::nodes_of(std::size_t box) const {
  const std::size_t x = box % count(0), y = box / count(0) % count(1), z = box / count(0) / count(1);
  std::array<std::size_t, 8> nodes;
  for (std::size_t k = 0; k < 8; ++k) {
    nodes[k] = x + (k & 1) + (count(0) + 1) * (y + (k >> 1 & 1) + (count(1) + 1) * (z + (k >> 2)));
  }
  return nodes;
}

std::array<double, 8> CoarseGrid::weights(const std::array<double, 3>& local) {
  std::array<double, 8> w;
  for (std::size_t k = 0; k < 8; ++k) {
    w[k] = 1.0;
    for (std::size_t i = 0; i < 3; ++i) w[k] *= (k >> i & 1) != 0 ? local[i] : 1.0 - local[i];
  }
  return w;
}

std::array<Vector, 8> CoarseGrid::gradients(const std::array<double, 3>& local) const {
  const auto factor = [&](std::size_t k, std::size_t i) {
    return (k >> i & 1) != 0 ? local[i] : 1.0 - local[i];
  };
  std::array<Vector, 8> G;
  for (std::size_t k = 0; k < 8; ++k) {
    for (std::size_t i = 0; i < 3; ++i) {
      const double slope = ((k >> i & 1) != 0 ? 1.0 : -1.0) / size_[i];
      G[k][i] = slope * factor(k, (i + 1) % 3) * factor(k, (i + 2) % 3);
    }
  }
  return G;
}

}  // namespace sandglass
