#pragma once

#include "assembly/resident.hpp"
#include "problem/model.hpp"
#include "problem/observer.hpp"

namespace sandglass {

/// The result of a dynamic run.
struct Motion {
  NodalField u;       ///< m, at the end
  NodalField v;       ///< m/s, at the end, at the same time as u
  double time = 0.0;  ///< s
  long steps = 0;
  double smallest_step = 0.0;  ///< s
  int most_substeps = 1;       ///< of small elements in a step; see Subcycling
  long repeated = 0;           ///< times that steps proved too long and were repeated with shorter ones
  bool never_adapted = false;  ///< an adaptive run that ended before levels were chosen
  bool interrupted = false;
  double seconds = 0.0;           ///< wall time of the steps
  StepTraffic traffic = {};       ///< of a step on another processor; no launches: the state stays here
  double adaption_seconds = 0.0;  ///< the share of it for the choice of levels, adaptive methods
};

/// Integrates the equations of motion with central differences, lumped unscaled masses and the case's
/// settings. Imposed displacements follow eq. 15 over the ramp time. A step chosen by the program follows the
/// stable one as elements stiffen; a step given by the user is rejected if it is above the stable one, at the
/// start (InputError) or later (ComputationError). If an element is inverted, displacements are no longer
/// finite or unexplained energy appears, the run returns to its last check and takes shorter steps from
/// there; it throws ComputationError if that does not help. The run can be resumed from every check; with
/// `from`, a checkpoint of the same model, it starts there, and nothing is reported twice.
Motion integrate(const Model& model, Observer& observer, const Checkpoint* from = nullptr);

}  // namespace sandglass
