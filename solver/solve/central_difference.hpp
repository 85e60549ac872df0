#pragma once

#include "problem/model.hpp"
#include "solve/observer.hpp"

namespace sandglass {

/// A dynamic answer.
struct Motion {
  NodalField u;       ///< m, at the end
  NodalField v;       ///< m/s, at the end: the same time as u
  double time = 0.0;  ///< s
  long steps = 0;
  double smallest_step = 0.0;  ///< s
  bool interrupted = false;
  double seconds = 0.0;           ///< wall time of the steps
  double adaption_seconds = 0.0;  ///< of it, that an adaptive method's choice of levels took
};

/// Integrates the equations of motion with central differences, lumped unscaled masses and the case's
/// settings. Imposed displacements follow eq. 15 over the ramp time. A step chosen by the program follows the
/// stable one as elements stiffen; a step given by the user is refused when it is above the stable one, at
/// the start (InputError) or on the way (ComputationError). Throws ComputationError when an element inverts
/// or the numbers stop being finite. Every check is a point from which the run can go on; with `from`, taken
/// there by a run of the same model, it does, and what was told before is not told again.
Motion integrate(const Model& model, Observer& observer, const Checkpoint* from = nullptr);

}  // namespace sandglass
