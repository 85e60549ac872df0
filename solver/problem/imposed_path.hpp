#pragma once

#include <array>
#include <cmath>
#include <cstddef>

namespace sandglass {

/// The three functions of the load factor f that make up imposed displacements: f, 1 - cos(f angle) and sin(f
/// angle); or their derivatives or changes.
using PathTerms = std::array<double, 3>;

/// The terms at load factor f, for an angle in rad.
inline PathTerms path_terms(double angle, double f) {
  if (angle == 0.0) return {f, 0.0, 0.0};
  const double half = std::sin(0.5 * f * angle);
  return {f, 2.0 * half * half, std::sin(f * angle)};
}

/// Their first derivatives with respect to f.
inline PathTerms path_rates(double angle, double f) {
  if (angle == 0.0) return {1.0, 0.0, 0.0};
  return {1.0, angle * std::sin(f * angle), angle * std::cos(f * angle)};
}

/// Their second derivatives with respect to f.
inline PathTerms path_accelerations(double angle, double f) {
  if (angle == 0.0) return {};
  return {0.0, angle * angle * std::cos(f * angle), -angle * angle * std::sin(f * angle)};
}

/// A displacement component as a function of the load factor f: u(f) = share . terms(f). A straight path has
/// only the first share, its final value.
struct ImposedPath {
  PathTerms share{};      ///< m, of each term
  std::size_t angle = 0;  ///< index into the scene's angles

  /// u (m), its derivative or its change, from the terms of the path's angle.
  double along(const PathTerms& terms) const {
    return share[0] * terms[0] + share[1] * terms[1] + share[2] * terms[2];
  }

  bool operator==(const ImposedPath&) const = default;
};

}  // namespace sandglass
