#include "commands/verify.hpp"

#include <fmt/format.h>

#include <filesystem>

#include "assembly/method_entry.hpp"
#include "base/error.hpp"
#include "commands/step_costs.hpp"
#include "commands/task_pool.hpp"
#include "solve/frame.hpp"

namespace sandglass {

namespace {

using Task = Verification::Task;

/// Every method on every scene, methods with a kappa at `auto` and along the case's kappa curve.
std::vector<Task> make_tasks(const std::deque<VerifiedScene>& scenes, Precision precision) {
  std::vector<Task> tasks;
  for (const auto& of : scenes) {
    for (const MethodEntry& method : methods()) {
      if (method.is_condensed && !of.scene.settings.quasi_static) continue;  // it has no motion
      tasks.push_back({&of, {std::string(method.name), {}, precision}});
      // A condensed method has the curve of the method that it condenses.
      if (!method.kappa_affects_equilibrium || method.is_condensed) continue;
      for (const double kappa : of.references.comparison.kappas) {
        tasks.push_back({&of, {std::string(method.name), kappa, precision}});
      }
    }
  }
  return tasks;
}

/// Adds the verdicts and answers of all tasks.
void run_all(Verification& all, int threads, const ProgressOf& progress) {
  const std::size_t count = all.tasks.size();
  all.verdicts.resize(count);
  all.answers.resize(count);
  const bool complete = run_tasks(
      count, threads,
      [&](std::size_t n) {
        const auto& [of, choice] = all.tasks[n];
        all.verdicts[n] = run_and_compare(of->scene, of->references, choice, all.answers[n]);
      },
      progress);
  if (!complete) throw ComputationError("verify: interrupted; nothing was written");
}

/// Measures the cost of steps, except in the cases with published values.
void add_costs(Verification& all, int threads, const ProgressOf& progress) {
  std::vector<VerifiedRun> runs;
  for (std::size_t n = 0; n < all.tasks.size(); ++n) {
    const auto& [of, choice] = all.tasks[n];
    if (!all.verdicts[n].published.empty()) continue;
    runs.push_back({&of->scene, choice, &all.answers[n], &all.verdicts[n]});
  }
  add_step_costs(runs, threads, progress);
}

}  // namespace

bool comparable(const Case& description) {
  return description.quasi_static || std::filesystem::exists(read_comparison(description).golden);
}

Verification verify(std::vector<Scene> scenes, const VerifyPlan& plan, const ProgressOf& progress) {
  Verification all;
  for (auto& scene : scenes) {
    References references = read_references(scene);
    all.scenes.push_back({std::move(scene), std::move(references)});
  }
  all.tasks = make_tasks(all.scenes, plan.precision);
  run_all(all, plan.threads, progress);
  if (plan.costs) add_costs(all, plan.threads, progress);
  for (const auto& [scene, references] : all.scenes) {
    if (plan.precision != Precision::double_precision) break;
    const auto checks = check_limits(scene.settings.name, references.comparison.expectations, all.verdicts);
    all.limits.insert(all.limits.end(), checks.begin(), checks.end());
  }
  return all;
}

void write_results(const Verification& verification, const std::string& folder,
                   const Provenance& provenance) {
  for (std::size_t n = 0; n < verification.tasks.size(); ++n) {
    const auto& [of, choice] = verification.tasks[n];
    const Displacements& u = verification.answers[n];
    if (u.empty()) continue;
    const Model model(of->scene, choice);
    const std::string kappa = choice.kappa ? fmt::format(".{}", *choice.kappa) : "";
    const auto path = std::filesystem::path(folder) /
                      fmt::format("{}.{}{}.h5", of->scene.settings.name, choice.method, kappa);
    ResultWriter writer(model, path, provenance);
    writer.frame(static_frame(model, 0.0, NodalField(u.back().size())));
    writer.frame(static_frame(model, 1.0, u.back()));
    writer.commit("complete");
  }
}

}  // namespace sandglass
