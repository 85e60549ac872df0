#pragma once

#include <optional>
#include <string>

namespace sandglass {

/// Answers per simulated second that a condensed method is asked for: it has no step of its own, and a
/// thousand are what the hand needs of a device that gives back forces.
inline constexpr double answers_per_second = 1000.0;

/// What the explicit steps of a method cost on a scene and machine. The cost of a static equilibrium is
/// another quantity; see Verdict.
struct StepCost {
  double seconds = 0.0;         ///< of a step, the mean over the motion, or of a condensed answer; median
  double lower_quartile = 0.0;  ///< s
  double upper_quartile = 0.0;  ///< s
  double checks = 0.0;          ///< s, of the checks of a run, shared out over the steps between them
  bool condensed = false;       ///< an answer instead of a step
  std::optional<double> mean_step = {};  ///< s, over the scene's own motion; none: no steps, or it fails
  std::string remark = {};               ///< about the steps of the motion; mostly empty

  /// Wall time of a simulated second, s: of its steps and checks. Below 1 is real time. None if the motion
  /// fails.
  std::optional<double> per_simulated_second() const {
    if (condensed) return seconds * answers_per_second;
    if (mean_step) return (seconds + checks) / *mean_step;
    return std::nullopt;
  }
};

}  // namespace sandglass
