#pragma once

#include <vector>

#include "choice/choose.hpp"
#include "comparison/verdict.hpp"

namespace sandglass {

/// A run of `verify` and its result.
struct VerifiedRun {
  const Scene* scene;
  MethodChoice choice;
  const Displacements* answer;  ///< empty if there is none
  Verdict* verdict;
};

/// Adds the cost of steps to the verdicts: computes the own motion of each scene and method on `threads`
/// threads (0: all processors), then, with nothing else running, times the steps of all methods of a scene in
/// turn. Points of a kappa curve get the time of their method, as kappa does not change the work, and its
/// mean step times the ratio of the undeformed stable steps. Throws ComputationError if interrupted.
void add_step_costs(const std::vector<VerifiedRun>& runs, int threads, const ProgressOf& progress);

}  // namespace sandglass
