#pragma once

#include <cmath>
#include <utility>

#include "forces/contact_force.hpp"

namespace sandglass {

/// When a search for equilibrium augments contact: three times, each at a tenth of the previous residual.
/// Nodes then sink into obstacles by 1e-6 of an edge, and the depth at the first residual no longer
/// influences the answer.
class AugmentationSchedule {
 public:
  explicit AugmentationSchedule(bool may_touch) : may_touch_(may_touch) {}

  /// How often contact was augmented since the start.
  int count() const { return count_; }

  /// Whether contact need not be augmented further.
  bool done() const { return !may_touch_ || done_; }

  /// The residual at which it is augmented, over that of the first time.
  double share_of_first_residual() const { return std::pow(0.1, count_); }

  Augmentation next() const { return count_ == 0 ? Augmentation::first : Augmentation::further; }

  /// Takes note of whether the next one changed forces.
  void augmented(bool changed) {
    if (changed) ++count_;
    done_ = !changed || count_ == most_;
  }

  /// Starts anew; returns the count until then.
  int restart() {
    done_ = false;
    return std::exchange(count_, 0);
  }

  /// From now on, augments once: in grooves there may be no equilibrium without depth.
  void limit_to_one() { most_ = 1; }

 private:
  bool may_touch_, done_ = false;
  int count_ = 0, most_ = 3;
};

}  // namespace sandglass
