#pragma once

#include <array>
#include <cmath>
#include <cstddef>

namespace sandglass {

/// The three functions of the load factor f that imposed displacements are made of: f, 1 - cos(f angle) and
/// sin(f angle); or derivatives of these, or their changes.
using PathTerms = std::array<double, 3>;

/// The terms at load factor f, for an angle in rad.
inline PathTerms path_terms(double angle, double f) {
  const double half = std::sin(0.5 * f * angle);
  return {f, 2.0 * half * half, std::sin(f * angle)};
}

/// Their first derivatives by f.
inline PathTerms path_rates(double angle, double f) {
  return {1.0, angle * std::sin(f * angle), angle * std::cos(f * angle)};
}

/// Their second derivatives by f.
inline PathTerms path_accelerations(double angle, double f) {
  return {0.0, angle * angle * std::cos(f * angle), -angle * angle * std::sin(f * angle)};
}

/// How a displacement component follows the load factor f: u(f) = share . terms(f). A straight path has a
/// first share only, its final value.
struct ImposedPath {
  PathTerms share{};      ///< m, of each term
  std::size_t angle = 0;  ///< which of the scene's angles

  /// u (m), or what becomes of it, at terms of the path's angle.
  double along(const PathTerms& terms) const {
    return share[0] * terms[0] + share[1] * terms[1] + share[2] * terms[2];
  }

  bool operator==(const ImposedPath&) const = default;
};

}  // namespace sandglass
