#pragma once

#include <cmath>

namespace sandglass {

/// Detects that a residual has reached the roundoff of the number type: it is below ten thousand epsilon, and
/// has not halved in 12 steps.
class Stagnation {
 public:
  /// `epsilon` is the number type's.
  explicit Stagnation(double epsilon) : reachable_(1e4 * epsilon) {}

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
