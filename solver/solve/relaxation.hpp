#pragma once

#include "problem/model.hpp"
#include "solve/observer.hpp"

namespace sandglass {

/// A static answer and how it was found.
struct Relaxation {
  NodalField u;              ///< m
  long steps = 0;            ///< evaluations of the internal forces
  double residual = 0.0;     ///< |force on free components| / |reactions and loads|
  bool converged = false;    ///< residual below the tolerance
  bool stagnated = false;    ///< the residual stopped falling before it was there
  bool interrupted = false;  ///< the observer asked to end
  StrainEnergies energies;   ///< at u
  double seconds = 0.0;      ///< wall time from the model to the answer
  /// Wall time of a step; of a condensed answer that of its superposition, without what all answers share.
  double step_seconds = 0.0;
  double adaption_seconds = 0.0;  ///< of the wall time, that an adaptive method's choice of levels took
};

/// Finds the displacements at which the internal forces balance. The imposed displacements and forces grow
/// in load levels; each starts from the line through the two answers before it, and is relaxed with
/// preconditioned conjugate gradients: coarsely on the way, to the tolerance at the end. A level that fails
/// is tried again at half the distance. A condensed method answers at once, by superposition, with one step.
/// Settings are the case's. Throws ComputationError when an element stays inverted or no level is short
/// enough. Every level begins at a point from which the search can go on; with `from`, taken there by a run
/// of the same model, it does, and what was told before is not told again. A condensed method has none.
Relaxation relax(const Model& model, Observer& observer, const Checkpoint* from = nullptr);

/// Whether the answer is as good as asked for, or as the numbers allow: in single precision the rounding of
/// the forces may keep the residual above the tolerance.
bool in_equilibrium(const Relaxation& relaxation, Precision precision);

/// How the search ended, in words: "at rest", or why not.
std::string outcome(const Relaxation& relaxation, Precision precision);

}  // namespace sandglass
