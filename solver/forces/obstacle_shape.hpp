#pragma once

#include <algorithm>
#include <cmath>

#include "mesh/vectors.hpp"

/// The geometry of obstacles, each with its half thickness (m), and for a point x (m), the distance from the
/// surface, negative inside, and its gradient.
namespace sandglass {

/// The signed distance (m) of a point from a surface, and the direction in which it grows, of length one.
struct Gap {
  double distance;
  Vector normal;
};

/// The direction of v; an arbitrary one if v is zero, as at the centre of a sphere.
inline Vector direction_of(const Vector& v, double length) {
  return length > 0.0 ? Vector{v[0] / length, v[1] / length, v[2] / length} : Vector{0.0, 0.0, 1.0};
}

/// The half-space below a plane.
struct PlaneShape {
  Vector point, normal;  ///< normal: of length one, to the outside

  double half_thickness() const { return INFINITY; }
  Gap at(const Vector& x) const { return {dot(normal, difference(x, point)), normal}; }
};

/// All points within a radius of a part of a line: one point, a segment, or the whole line.
struct RoundShape {
  Vector start, axis;  ///< the line start + t axis
  double low, high;    ///< of t
  double radius;       ///< m

  double half_thickness() const { return radius; }
  Gap at(const Vector& x) const {
    const Vector from = difference(x, start);
    const double t = std::clamp(dot(from, axis) / std::max(dot(axis, axis), smallest), low, high);
    const Vector arm = sum(from, -t, axis);
    const double r = std::sqrt(dot(arm, arm));
    return {r - radius, direction_of(arm, r)};
  }

 private:
  static constexpr double smallest = 1e-300;
};

/// A box along the coordinate axes.
struct BoxShape {
  Vector centre, half_sizes;

  double half_thickness() const { return *std::ranges::min_element(half_sizes); }
  Gap at(const Vector& x) const {
    const Vector from = difference(x, centre);
    Vector beyond{}, outside{};
    for (std::size_t i = 0; i < 3; ++i) {
      beyond[i] = std::abs(from[i]) - half_sizes[i];
      outside[i] = std::copysign(std::max(beyond[i], 0.0), from[i]);
    }
    const double r = std::sqrt(dot(outside, outside));
    if (r > 0.0) return {r, direction_of(outside, r)};
    const auto nearest = static_cast<std::size_t>(std::ranges::max_element(beyond) - beyond.begin());
    Vector normal{};
    normal[nearest] = std::copysign(1.0, from[nearest]);
    return {beyond[nearest], normal};
  }
};

/// An ellipsoid with its axes along the coordinate axes.
struct EllipsoidShape {
  Vector centre, semi_axes;

  double half_thickness() const { return *std::ranges::min_element(semi_axes); }

  /// The nearest point of the surface is y = a^2 x / (a^2 + t), by components, for the t (m^2) that puts it
  /// on the surface; the distance is t |y / a^2|. The equation for t is convex and falls, so that Newton's
  /// method ascends after its first step, which must not pass a lower bound of t. It starts from zero, the
  /// answer on the surface. Points near the middle of the ellipsoid, which have several nearest points, get
  /// any of them.
  Gap at(const Vector& x) const {
    constexpr int most = 60;
    constexpr double rounding = 1e-15, nearly = 1e-10;
    const Vector from = difference(x, centre);
    double least = -INFINITY, smallest = INFINITY;
    for (std::size_t i = 0; i < 3; ++i) {
      least = std::max(least, semi_axes[i] * (std::abs(from[i]) - semi_axes[i]));
      smallest = std::min(smallest, semi_axes[i]);
    }
    double t = std::max(least, 0.0);
    Vector slope{};  // y / a^2
    bool arrived = false;
    for (int n = 0; n < most; ++n) {
      double excess = -1.0, derivative = 0.0;
      for (std::size_t i = 0; i < 3; ++i) {
        const double a2 = semi_axes[i] * semi_axes[i], inverse = 1.0 / std::max(a2 + t, rounding * a2);
        slope[i] = from[i] * inverse;
        excess += a2 * slope[i] * slope[i];
        derivative += 2.0 * a2 * slope[i] * slope[i] * inverse;
      }
      if (arrived) break;
      const double step = derivative > 0.0 ? excess / derivative : 0.0, before = t;
      t = std::max(t + step, least);
      const double moved = std::abs(t - before) / (smallest * smallest);
      if (moved <= rounding) break;
      arrived = moved <= nearly;  // what remains is its square
    }
    const double size = std::sqrt(dot(slope, slope));
    return {size > 0.0 ? t * size : -smallest, direction_of(slope, size)};
  }
};

}  // namespace sandglass
