#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

namespace sandglass {

/// The map that rounds a cube (D = 3) or a square (D = 2) for the cores of balls and discs: with x in
/// [-1,1]^D, m = max |x_i| and t = tan(pi x / 4), the surface point of the ball is t/|t|, and the image of x
/// in the ball is m t/|t|.
template <std::size_t D>
struct Bulge {
  std::array<double, D> x;

  /// t/|t|, the direction in which the point leaves the core; zero at the centre.
  std::array<double, D> direction() const {
    std::array<double, D> t{};
    double square = 0.0;
    for (std::size_t i = 0; i < D; ++i) {
      t[i] = std::tan(std::numbers::pi / 4.0 * x[i]);
      square += t[i] * t[i];
    }
    for (auto& component : t) component /= square > 0.0 ? std::sqrt(square) : 1.0;
    return t;
  }

  /// size (x/2 + bulge m t/|t|), a point of the core.
  std::array<double, D> core_point(double size, double bulge) const {
    double m = 0.0;
    for (const double component : x) m = std::max(m, std::abs(component));
    std::array<double, D> point = direction();
    for (std::size_t i = 0; i < D; ++i) point[i] = size * (0.5 * x[i] + bulge * m * point[i]);
    return point;
  }
};

}  // namespace sandglass
