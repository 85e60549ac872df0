#include "choice/candidate_cost.hpp"

#include <map>
#include <tuple>

#include "assembly/method_entry.hpp"
#include "base/error.hpp"

namespace sandglass {

namespace {

/// The motions' share of the work, to show progress.
constexpr double of_motions = 0.8;

/// The key of candidates that share a motion: neither precision nor kappa changes its steps noticeably.
using MotionKey = std::tuple<const CandidateMesh*, std::string, double>;

MotionKey motion_key(const Candidate& candidate) {
  return {candidate.mesh, candidate.choice.method, candidate.choice.accuracy};
}

/// Follows the motion of a candidate. A motion that cannot be set up counts as failed.
OwnMotion follow(const Candidate& candidate, const Proceed& proceed) {
  try {
    MethodChoice choice = candidate.choice;
    choice.kappa.reset();
    return follow_own_motion(candidate.mesh->scene, choice, proceed);
  } catch (const InputError& error) {
    const std::string text = error.what();
    return {.remark = text.substr(0, text.find('\n'))};
  }
}

}  // namespace

std::vector<Costing> measure_costs(std::span<const Candidate> candidates, const Proceed& proceed) {
  std::vector<Costing> costings(candidates.size());
  std::map<MotionKey, OwnMotion> motions;
  std::vector<CostTask> tasks;
  std::vector<std::size_t> of_task;
  for (std::size_t n = 0; n < candidates.size(); ++n) {
    const Candidate& candidate = candidates[n];
    if (!candidate.unfit.empty()) continue;
    CostTask task{&candidate.mesh->scene, candidate.choice};
    if (!method_named(candidate.choice.method).is_condensed) {
      const auto [found, is_new] = motions.try_emplace(motion_key(candidate));
      if (is_new) {
        found->second = follow(candidate, [&](double share) {
          return proceed(of_motions * (static_cast<double>(n) + share) /
                         static_cast<double>(candidates.size()));
        });
      }
      task.motion = &found->second;
      if (!found->second.mean_step) {
        costings[n].status = found->second.remark;
        continue;
      }
    }
    tasks.push_back(task);
    of_task.push_back(n);
  }
  const auto timed = sandglass::measure_costs(std::span<const CostTask>(tasks), [&](double share) {
    return proceed(of_motions + (1.0 - of_motions) * share);
  });
  for (std::size_t k = 0; k < timed.size(); ++k) costings[of_task[k]] = timed[k];
  return costings;
}

}  // namespace sandglass
