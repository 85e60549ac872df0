#pragma once

#include <span>
#include <string>
#include <vector>

#include "benchmark/measure.hpp"
#include "benchmark/own_motion.hpp"
#include "comparison/step_cost.hpp"

namespace sandglass {

/// A method on a scene whose steps are to be timed.
struct CostTask {
  const Scene* scene;
  MethodChoice choice;
  const OwnMotion* motion = nullptr;  ///< of this scene and method; null: it takes no steps
};

/// The cost of a task, or the reason why there is none.
struct Costing {
  std::optional<StepCost> cost = {};
  std::string status = "ok";
};

/// The time (s) of a run's checks, divided among its steps; for an adaptive method it includes the choice of
/// levels.
double checks_per_step(const Timing& timing, const Scene& scene, const OwnMotion* motion);

/// Times the steps of all tasks on this machine with the loop of `bench`: batches of all in turn, each time
/// in another order, on one processor if all run on one thread. Bodies start at the end of their own motion,
/// with the levels of elements that occurred in it, or, if it fails, from waves. A task that cannot be set up
/// gets a status. Throws ComputationError if interrupted.
std::vector<Costing> measure_costs(std::span<const CostTask> tasks, const Proceed& proceed);

}  // namespace sandglass
