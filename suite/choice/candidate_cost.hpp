#pragma once

#include <span>
#include <vector>

#include "benchmark/cost.hpp"
#include "choice/candidates.hpp"

namespace sandglass {

/// The costs of candidates on this machine: follows the own motion of each mesh and method for its mean step,
/// then times the steps of all. Candidates that differ only in kappa share motion and time, because the work
/// is the same; unfit ones are omitted. If a motion fails there is no cost, and the status says why. Throws
/// ComputationError if interrupted.
std::vector<Costing> measure_costs(std::span<const Candidate> candidates, const Proceed& proceed);

}  // namespace sandglass
