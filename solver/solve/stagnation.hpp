#pragma once

#include <algorithm>
#include <cmath>

namespace sandglass {

/// Detects that a residual has reached the roundoff of the number type: it has not halved in 12 steps, and is
/// below ten thousand epsilon, or more where a nearly incompressible law amplifies the roundoff of J - 1.
class Stagnation {
 public:
  /// `epsilon` is the number type's, `amplification` the largest lambda / mu of the body.
  Stagnation(double epsilon, double amplification)
      : reachable_(1e4 * epsilon * std::max(1.0, 0.01 * amplification)) {}

  /// Records the residual of another step.
  void take(double residual) {
    ++waited_;
    if (residual < 0.5 * halved_) {
      halved_ = residual;
      waited_ = 0;
    }
  }

  /// Whether the residual is so low that roundoff may be all that is left.
  bool at_roundoff() const { return halved_ < reachable_; }

  bool reached() const { return at_roundoff() && waited_ >= 12; }

 private:
  double reachable_;
  double halved_ = INFINITY;  ///< the residual when it last halved
  long waited_ = 0;
};

}  // namespace sandglass
