#pragma once

#include <algorithm>
#include <cmath>

namespace sandglass {

/// Detects energy that no work explains, because too long steps feed the fastest vibrations.
class EnergyWatch {
 public:
  /// Takes a motion's energy and the work done on it (J), and the step (s). Returns whether the difference
  /// has risen noticeably above its smallest value since the last change of the step, which changes the
  /// conserved energy.
  bool rises(double energy, double work, double step) {
    constexpr double noticeable = 0.02;  // of the largest energy
    largest_ = std::max({largest_, energy, std::abs(work)});
    least_ = step == step_ ? std::min(least_, energy - work) : energy - work;
    step_ = step;
    return !(energy - work - least_ <= noticeable * largest_);
  }

  template <class Archive>
  void keep(Archive& archive) {
    archive("largest energy", largest_);
    archive("least unexplained energy", least_);
    archive("step of least unexplained energy", step_);
  }

 private:
  double largest_ = 0.0, least_ = 0.0;  // J
  double step_ = 0.0;                   // s
};

}  // namespace sandglass
