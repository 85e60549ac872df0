#pragma once

#include <algorithm>

#include "problem/settings.hpp"

namespace sandglass {

/// The paper's loading curve (eq. 15) over relative time: from 0 to 1, with zero velocity and acceleration at
/// both ends; and its derivatives with respect to relative time.
struct LoadingCurve {
  explicit constexpr LoadingCurve(double relative_time) : t(std::clamp(relative_time, 0.0, 1.0)) {}
  constexpr double value() const { return t * t * t * (10.0 + t * (-15.0 + t * 6.0)); }
  constexpr double rate() const { return 30.0 * t * t * (1.0 - t) * (1.0 - t); }
  constexpr double acceleration() const { return 60.0 * t * (1.0 - t) * (1.0 - 2.0 * t); }
  double t;
};

/// The time (s) in which a motion's load grows.
inline double ramp_time(const DynamicsSettings& settings) {
  return settings.ramp_time > 0.0 ? settings.ramp_time : settings.duration;
}

/// The loading curve of a motion at a time (s).
inline LoadingCurve loading_curve(const DynamicsSettings& settings, double time) {
  return LoadingCurve(time / ramp_time(settings));
}

}  // namespace sandglass
