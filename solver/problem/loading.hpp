#pragma once

#include <algorithm>

namespace sandglass {

/// The paper's loading curve (eq. 15) over relative time: from 0 to 1, with zero velocity and acceleration at
/// both ends.
constexpr double loading_curve(double relative_time) {
  const double t = std::clamp(relative_time, 0.0, 1.0);
  return t * t * t * (10.0 + t * (-15.0 + t * 6.0));
}

/// Its first derivative by relative time.
constexpr double loading_curve_rate(double relative_time) {
  const double t = std::clamp(relative_time, 0.0, 1.0);
  return 30.0 * t * t * (1.0 - t) * (1.0 - t);
}

/// Its second derivative by relative time.
constexpr double loading_curve_acceleration(double relative_time) {
  const double t = std::clamp(relative_time, 0.0, 1.0);
  return 60.0 * t * (1.0 - t) * (1.0 - 2.0 * t);
}

}  // namespace sandglass
