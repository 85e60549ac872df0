#pragma once

#include <cmath>
#include <vector>

#include "solve/equilibrium.hpp"

namespace sandglass {

/// The state with the smallest residual of a search that only rounding keeps from its tolerance: such a
/// search may drift.
template <class Real>
class BestState {
 public:
  /// Keeps the state of the last evaluation if its residual is the smallest.
  void take(Equilibrium<Real>& equilibrium) {
    if (!(equilibrium.residual() < residual_)) return;
    residual_ = equilibrium.residual();
    state_ = equilibrium.body().state();
    pressures_ = equilibrium.pressures();
  }

  /// Restores that state; `Equilibrium::start` must follow. Returns false if there is none.
  bool restore(Equilibrium<Real>& equilibrium) const {
    if (std::isinf(residual_)) return false;
    equilibrium.body().state() = state_;
    equilibrium.pressures() = pressures_;
    return true;
  }

 private:
  double residual_ = INFINITY;
  State<Real> state_;
  std::vector<Real> pressures_;
};

}  // namespace sandglass
