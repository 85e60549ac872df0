#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "benchmark/measure.hpp"
#include "choice/ladder.hpp"

namespace sandglass {

/// Answers per simulated second that a condensed method is asked for: it has no step of its own, and a
/// thousand are what the hand needs of a device that gives back forces.
inline constexpr double answers_per_second = 1000.0;

/// What a rung costs on this machine.
struct Cost {
  double seconds = 0.0;                  ///< of a step, or of a condensed answer; median
  std::optional<double> step_size = {};  ///< s, of the scene as a real-time loop would run it; none: no steps

  /// Wall time of a simulated second, s. Below 1 is real time.
  double per_simulated_second() const;
};

/// The cost of a rung, or why there is none.
struct Costing {
  std::optional<Cost> cost;
  std::string status = "ok";
};

/// Times the steps of all rungs on this machine, in turn: batches of all, in another order each time. The
/// body stands where the reference has it, under its full load. The step is the case's share of the stable
/// one there or at rest, whichever is shorter. Rungs that do the same work are timed once. One that cannot be
/// set up gets a status. Throws ComputationError when told to end.
std::vector<Costing> measure_costs(std::span<const Rung> rungs, const Proceed& proceed);

}  // namespace sandglass
