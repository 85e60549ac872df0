#pragma once

#include <algorithm>
#include <cmath>

namespace sandglass {

/// Detects that a residual has reached the roundoff of the number type: it has not halved in 12 steps and is
/// below ten thousand epsilon (more if a nearly incompressible law amplifies the roundoff of J - 1, but at
/// most a tenth); or the body reports that the remaining forces are within its rounding.
class Stagnation {
 public:
  /// `epsilon` is the number type's, `amplification` the largest lambda / mu of the body.
  Stagnation(double epsilon, double amplification)
      : reachable_(std::min(0.1, 1e4 * epsilon * std::max(1.0, 0.01 * amplification))) {}

  /// Records the residual of another step, and whether it is within the body's rounding.
  void take(double residual, bool at_rounding) {
    ++waited_;
    at_rounding_ = at_rounding;
    if (residual < 0.5 * halved_) {
      halved_ = residual;
      waited_ = 0;
    }
  }

  /// Whether the residual is so low that it may be roundoff only.
  bool at_roundoff() const { return at_rounding_ || halved_ < reachable_; }

  /// Whether a given residual is that low.
  bool reaches(double residual) const { return residual < reachable_; }

  bool reached() const { return at_roundoff() && waited_ >= 12; }

 private:
  double reachable_;
  double halved_ = INFINITY;  ///< the residual when it last halved
  long waited_ = 0;
  bool at_rounding_ = false;
};

}  // namespace sandglass
