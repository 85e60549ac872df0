#pragma once

#include <optional>

namespace sandglass {

/// The modulus that kappa multiplies: lambda + 2 mu, as the paper has it (eq. 9), or mu, with which one
/// number serves nearly incompressible materials too, because mu stays finite as nu -> 1/2.
enum class KappaModulus { p_wave, shear };

/// What a user may choose of an hourglass control.
struct HourglassSettings {
  std::optional<double> kappa;  ///< stiffness parameter, -; none means `auto`, the control's own choice
  KappaModulus kappa_modulus = KappaModulus::p_wave;  ///< what kappa multiplies
};

}  // namespace sandglass
