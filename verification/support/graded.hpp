#pragma once

#include <cmath>

namespace sandglass::verification {

/// Places along a line through the origin, up to `size` (m) to both sides, denser near the origin: the last
/// edge of n is about exp(grade) times as long as the first.
struct Graded {
  double size, grade;

  /// Where the share s of the way is, m.
  double operator()(double s) const { return size * std::sinh(grade * s) / std::sinh(grade); }

  /// The length that belongs to the place x (m) between n edges to each side, m.
  double width_at(double x, int n) const {
    const double s = std::asinh(x / size * std::sinh(grade)) / grade, h = 1.0 / n;
    return 0.5 * ((*this)(s + h) - (*this)(s - h));
  }
};

}  // namespace sandglass::verification
