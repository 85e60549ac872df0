#pragma once

#include <optional>

namespace sandglass {

/// What a user may choose of an hourglass control.
struct HourglassSettings {
  std::optional<double> kappa;  ///< stiffness parameter, -; none means `auto`, the control's own choice
};

}  // namespace sandglass
