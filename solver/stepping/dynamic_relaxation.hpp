#pragma once

#include "model/model.hpp"
#include "stepping/observer.hpp"

namespace sandglass {

/// A static answer and how it was found.
struct Relaxation {
  NodalField u;  ///< m
  long steps = 0;
  double residual = 0.0;     ///< |force on free components| / |reactions|
  bool converged = false;    ///< residual below the tolerance
  bool interrupted = false;  ///< the observer asked to end
  StrainEnergies energies;   ///< at u
  double seconds = 0.0;      ///< wall time of the steps
};

/// Ramps the imposed displacements along eq. 15 and relaxes to rest with central differences in a pseudo time
/// whose step is 1. Masses are scaled so that every element is equally critical; damping follows the lowest
/// frequency that is still moving, from the Rayleigh quotient of the last increment (Underwood 1983; Joldes,
/// Wittek and Miller 2009). Settings are the case's. Throws ComputationError when an element inverts or the
/// numbers stop being finite.
Relaxation relax(const Model& model, Observer& observer);

}  // namespace sandglass
