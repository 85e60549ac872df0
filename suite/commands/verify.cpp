#include "commands/verify.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>

#include "assembly/method_entry.hpp"
#include "assembly/processor.hpp"
#include "base/error.hpp"
#include "commands/step_costs.hpp"
#include "commands/task_pool.hpp"
#include "solve/frame.hpp"

namespace sandglass {

namespace {

using Task = Verification::Task;

/// Adds every method on every scene, methods with a kappa at `auto` and along the case's kappa curve.
void add_tasks(Verification& all, const VerifyPlan& plan) {
  for (const auto& of : all.scenes) {
    const std::size_t tasks_before = all.tasks.size(), left_out_before = all.left_out.size();
    for (const MethodEntry& method : methods()) {
      if (method.is_condensed && !of.scene.settings.quasi_static) continue;  // it has no motion
      MethodChoice choice{
          .method = std::string(method.name), .precision = plan.precision, .processor = plan.processor};
      if (std::string reason; plan.processor != nullptr &&
                              !(reason = plan.processor->refusal(of.scene.materials, choice)).empty()) {
        all.left_out.push_back({of.scene.settings.name, choice.method, std::move(reason)});
        continue;
      }
      all.tasks.push_back({&of, choice});
      // A condensed method has the curve of the method that it condenses.
      if (!method.kappa_affects_equilibrium || method.is_condensed) continue;
      for (const double kappa : of.references.comparison.kappas) {
        choice.kappa = kappa;
        all.tasks.push_back({&of, choice});
      }
    }
    if (all.tasks.size() == tasks_before && all.left_out.size() > left_out_before)
      throw InputError(fmt::format("{}: nothing can be computed on this device: {}",
                                   of.scene.settings.file.string(), all.left_out[left_out_before].reason));
  }
}

/// The limits of a scene for methods that were computed.
std::vector<Expectation> limits_of(const VerifiedScene& scene, const std::vector<Task>& tasks) {
  std::vector<Expectation> limits = scene.references.comparison.expectations;
  std::erase_if(limits, [&](const Expectation& limit) {
    return std::ranges::none_of(
        tasks, [&](const Task& task) { return task.of == &scene && task.choice.method == limit.method; });
  });
  return limits;
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
  if (description.quasi_static) return true;
  const Comparison comparison = read_comparison(description);
  return std::filesystem::exists(comparison.golden) || !comparison.published.empty();
}

Verification verify(std::vector<Scene> scenes, const VerifyPlan& plan, const ProgressOf& progress) {
  Verification all;
  for (auto& scene : scenes) {
    References references = read_references(scene);
    all.scenes.push_back({std::move(scene), std::move(references)});
  }
  add_tasks(all, plan);
  run_all(all, plan.threads, progress);
  if (plan.costs && plan.processor == nullptr) add_costs(all, plan.threads, progress);
  for (const VerifiedScene& of : all.scenes) {
    if (plan.precision != Precision::double_precision) break;
    const auto checks = check_limits(of.scene.settings.name, limits_of(of, all.tasks), all.verdicts);
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
