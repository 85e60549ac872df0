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

/// The cost of a task, or why there is none.
struct Costing {
  std::optional<StepCost> cost = {};
  std::string status = "ok";
};

/// The checks of a run, shared out over its steps, s; with the choice of levels of a method that adapts.
double checks_per_step(const Timing& timing, const Scene& scene, const OwnMotion* motion);

/// Times the steps of all tasks on this machine with the loop of `bench`: batches of all in turn, in another
/// order each time, on one processor if all run on one thread. Bodies stand where their own motion ends, with
/// the levels of the elements on its way, or, where it fails, are stirred by waves. One that cannot be set up
/// gets a status. Throws ComputationError when told to end.
std::vector<Costing> measure_costs(std::span<const CostTask> tasks, const Proceed& proceed);

}  // namespace sandglass
