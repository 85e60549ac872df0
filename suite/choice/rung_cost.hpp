#pragma once

#include <span>
#include <vector>

#include "benchmark/cost.hpp"
#include "choice/ladder.hpp"

namespace sandglass {

/// The costs of rungs on this machine: follows the own motion of each mesh and method for its mean step, then
/// times the steps of all. Rungs that differ only in kappa share motion and time, because the work is the
/// same; unfit ones are omitted. If a motion fails there is no cost, and the status says why. Throws
/// ComputationError if interrupted.
std::vector<Costing> measure_costs(std::span<const Rung> rungs, const Proceed& proceed);

}  // namespace sandglass
