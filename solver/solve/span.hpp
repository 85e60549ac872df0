#pragma once

#include <algorithm>

#include "mesh/mesh.hpp"

namespace sandglass {

/// Twice the largest distance (m) of some points from their mean, which does not depend on their orientation.
inline double span(const NodalField& points) {
  const double count = static_cast<double>(points.size());
  Vector mean{};
  for (const Vector& x : points) {
    for (std::size_t i = 0; i < 3; ++i) mean[i] += x[i] / count;
  }
  double radius = 0.0;
  for (const Vector& x : points)
    radius = std::max(radius, length({x[0] - mean[0], x[1] - mean[1], x[2] - mean[2]}));
  return 2.0 * radius;
}

}  // namespace sandglass
