#pragma once

#include <optional>

namespace sandglass {

/// The modulus that kappa multiplies: lambda + 2 mu, as the paper has it (eq. 9), or mu, with which one
/// number serves nearly incompressible materials too, because mu stays finite as nu -> 1/2.
enum class KappaModulus { p_wave, shear };

/// What an hourglass control is told beside shape and law.
struct HourglassSettings {
  std::optional<double> kappa;  ///< strength, -; none means `auto`, the control's own choice
  double density = 0.0;         ///< kg/m^3 at rest, for controls that damp; without inertia they do nothing
  KappaModulus kappa_modulus = KappaModulus::p_wave;  ///< what kappa multiplies
};

}  // namespace sandglass
