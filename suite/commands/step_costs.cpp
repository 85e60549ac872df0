#include "commands/step_costs.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <atomic>

#include "assembly/method_entry.hpp"
#include "base/error.hpp"
#include "benchmark/cost.hpp"
#include "commands/task_pool.hpp"

namespace sandglass {

namespace {

[[noreturn]] void fail_interrupted() {
  throw ComputationError("verify: interrupted; nothing was written");
}

/// Longer motions, of more than about ten seconds, are not followed: such cases are about accuracy.
constexpr double most_element_steps = 1e8;

/// The motion that a run has already computed.
OwnMotion motion_of(const VerifiedRun& run) {
  const auto& [seconds, steps] = *run.verdict->motion;
  return {.mean_step = run.scene->settings.dynamics.duration / static_cast<double>(steps),
          .end = run.answer->back()};
}

OwnMotion own_motion_of(const VerifiedRun& run, const Proceed& proceed) {
  if (method_named(run.choice.method).is_condensed) return {};
  if (run.scene->settings.quasi_static || method_named(run.choice.method).adapts()) {
    return follow_own_motion(*run.scene, run.choice, proceed, most_element_steps);
  }
  return run.verdict->motion ? motion_of(run) : OwnMotion{.remark = run.verdict->status};
}

/// Times the steps of the runs of one scene, which start at `first`.
void time_steps(const std::vector<VerifiedRun>& runs, const std::vector<OwnMotion>& motions,
                std::size_t first, std::size_t last, const Proceed& proceed) {
  std::vector<CostTask> tasks;
  for (std::size_t n = first; n < last; ++n) {
    const bool condensed = method_named(runs[n].choice.method).is_condensed;
    tasks.push_back({runs[n].scene, runs[n].choice, condensed ? nullptr : &motions[n]});
  }
  const auto costings = measure_costs(tasks, proceed);
  for (std::size_t n = first; n < last; ++n) runs[n].verdict->step_cost = costings[n - first].cost;
}

/// The cost at a kappa other than the method's own.
std::optional<StepCost> at_kappa_of(const Verdict& verdict, const Verdict& own) {
  std::optional<StepCost> cost = own.step_cost;
  if (cost && cost->mean_step) *cost->mean_step *= verdict.stable_step / own.stable_step;
  return cost;
}

}  // namespace

void add_step_costs(const std::vector<VerifiedRun>& runs, int threads, const ProgressOf& progress) {
  std::vector<VerifiedRun> main_runs;
  for (const auto& run : runs) {
    if (!run.choice.kappa) main_runs.push_back(run);
  }
  std::vector<OwnMotion> motions(main_runs.size());
  std::atomic<bool> interrupted = false;  // the threads of the pool must not report progress themselves
  const bool complete = run_tasks(
      main_runs.size(), threads,
      [&](std::size_t n) { motions[n] = own_motion_of(main_runs[n], [&](double) { return !interrupted; }); },
      [&](double share, const std::string& remark) {
        const bool proceeds = progress(share, "motions: " + remark);
        interrupted = !proceeds;
        return proceeds;
      });
  if (!complete) fail_interrupted();
  for (std::size_t first = 0; first < main_runs.size();) {
    std::size_t last = first;
    while (last < main_runs.size() && main_runs[last].scene == main_runs[first].scene) ++last;
    time_steps(main_runs, motions, first, last, [&](double share) {
      const double done = static_cast<double>(first) + share * static_cast<double>(last - first);
      return progress(done / static_cast<double>(main_runs.size()),
                      "steps: " + main_runs[first].scene->settings.name);
    });
    first = last;
  }
  for (const auto& run : runs) {
    if (!run.choice.kappa) continue;
    const auto own = std::find_if(main_runs.begin(), main_runs.end(), [&](const VerifiedRun& other) {
      return other.scene == run.scene && other.choice.method == run.choice.method;
    });
    run.verdict->step_cost = at_kappa_of(*run.verdict, *own->verdict);
  }
}

}  // namespace sandglass
