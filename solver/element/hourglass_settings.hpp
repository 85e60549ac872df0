#pragma once

#include <optional>

#include "element/traits.hpp"

namespace sandglass {

/// The modulus that kappa multiplies: lambda + 2 mu as in the paper (eq. 9), or mu, for which one value of
/// kappa also serves nearly incompressible materials, because mu stays finite as nu -> 1/2.
enum class KappaModulus { p_wave, shear };

/// The settings of an hourglass control.
struct HourglassSettings {
  std::optional<double> kappa;  ///< strength, -; none means `auto`, the control's own choice
  double density = 0.0;  ///< reference density, kg/m^3, for controls that damp; with zero they give no force
  KappaModulus kappa_modulus = KappaModulus::p_wave;  ///< what kappa multiplies
};

}  // namespace sandglass
