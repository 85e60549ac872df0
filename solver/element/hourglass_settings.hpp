#pragma once

#include <optional>

namespace sandglass {

/// What an hourglass control is told beside shape and law.
struct HourglassSettings {
  std::optional<double> kappa;  ///< strength, -; none means `auto`, the control's own choice
  double density = 0.0;         ///< kg/m^3 at rest, for controls that damp; without inertia they do nothing
};

}  // namespace sandglass
