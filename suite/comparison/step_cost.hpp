#pragma once

#include <optional>
#include <string>

namespace sandglass {

/// Answers per simulated second of a condensed method, which has no steps: a thousand, as a haptic device
/// needs.
inline constexpr double answers_per_second = 1000.0;

/// The cost of a method's explicit steps on a scene and machine. The cost of a static equilibrium is another
/// quantity; see Verdict.
struct StepCost {
  double seconds = 0.0;         ///< median time of a step (mean over the motion) or a condensed answer
  double lower_quartile = 0.0;  ///< s
  double upper_quartile = 0.0;  ///< s
  double checks = 0.0;          ///< s, time of a run's checks, divided among the steps between them
  bool condensed = false;       ///< an answer instead of a step
  std::optional<double> mean_step = {};  ///< s, over the scene's own motion; none: no steps, or it fails
  std::string remark = {};               ///< about the steps of the motion; mostly empty

  /// Wall time (s) of the steps and checks of a simulated second. Below 1 is real time. None if the motion
  /// fails.
  std::optional<double> per_simulated_second() const {
    if (condensed) return seconds * answers_per_second;
    if (mean_step) return (seconds + checks) / *mean_step;
    return std::nullopt;
  }
};

}  // namespace sandglass
