#include "commands/bench.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "assembly/method_entry.hpp"
#include "base/error.hpp"
#include "benchmark/one_processor.hpp"
#include "benchmark/stepped_model.hpp"
#include "commands/execution_options.hpp"
#include "commands/workspace.hpp"
#include "comparison/comparison.hpp"

namespace sandglass {

namespace {

template <class Value>
std::vector<Value> without_repeats(const std::vector<Value>& values) {
  std::vector<Value> kept;
  for (const auto& value : values) {
    if (std::find(kept.begin(), kept.end(), value) == kept.end()) kept.push_back(value);
  }
  return kept;
}

/// Packs only, by default on one thread.
std::vector<MethodChoice> packed_variants(BenchPlan plan) {
  if (plan.threads.empty()) plan.threads = {1};
  auto variants = variants_of(completed(std::move(plan)));
  std::erase_if(variants, [](const MethodChoice& choice) { return choice.kernel == KernelWidth::scalar; });
  return variants;
}

/// Progress of part n of `count`.
Proceed part_of(const ProgressOf& progress, std::size_t n, std::size_t count, const std::string& remark) {
  return [=, &progress](double share) {
    return progress((static_cast<double>(n) + share) / static_cast<double>(count), remark);
  };
}

}  // namespace

std::vector<BenchSubject> bench_subjects(const std::vector<std::string>& names,
                                         const std::vector<int>& elements, const std::vector<int>& cubes) {
  constexpr int most = 100'000'000;
  std::vector<BenchSubject> subjects;
  for (const auto& name : names) subjects.push_back({find_case(name)});
  for (const int count : elements) {
    require_count("--elements", count, most);
    subjects.push_back({{}, count});
  }
  for (const int count : cubes) {
    require_count("--cubes", count, most);
    subjects.push_back({{}, count, Shapes::parallelepipeds});
  }
  if (subjects.empty()) subjects.push_back({find_case("ellipsoid-indentation")});
  return subjects;
}

BenchPlan completed(BenchPlan plan) {
  for (const auto& name : plan.methods) method_named(name, "--methods");
  plan.methods = plan.methods.empty() ? method_names() : without_repeats(plan.methods);
  plan.precisions = without_repeats(plan.precisions);
  plan.threads = without_repeats(plan.threads);
  if (plan.threads.empty()) plan.threads = available_processors() > 1 ? std::vector{1, 2} : std::vector{1};
  return plan;
}

std::vector<BenchRecord> bench_all(const std::vector<BenchSubject>& subjects, const BenchPlan& plan,
                                   MachineSpeed& machine, const SceneOf& scene_of, const ProgressOf& progress,
                                   const std::function<void(const std::vector<BenchRecord>&)>& each) {
  std::vector<BenchRecord> records;
  for (std::size_t n = 0; n < subjects.size(); ++n) {
    const auto& [description, elements, shapes] = subjects[n];
    const Scene scene = description ? scene_of(*description) : box_scene(elements, shapes);
    const Proceed proceed =
        part_of(progress, n, subjects.size(),
                fmt::format("{}, {} elements", scene.settings.name, scene.mesh.cells.size()));
    OwnMotions motions;  // boxes have none
    if (description) motions = follow_own_motions(scene, plan.methods, proceed);
    const auto found = bench(scene, motions, plan, machine, proceed);
    each(found);
    records.insert(records.end(), found.begin(), found.end());
  }
  return records;
}

std::vector<Case> cases_for_rest(const std::vector<std::string>& names) {
  auto cases = named_cases(
      names, [](const Case& description) { return description.quasi_static; }, "static equilibrium to time");
  if (names.empty()) {
    std::erase_if(cases,
                  [](const Case& description) { return !read_comparison(description).published.empty(); });
  }
  return cases;
}

std::vector<RestRecord> rest_all(
    const std::vector<Scene>& scenes, BenchPlan plan, const ProgressOf& progress,
    const std::function<void(const Scene&, const std::vector<RestRecord>&)>& each) {
  if (plan.methods.empty()) plan.methods = {"tl-perturbation", std::string(golden_method)};
  const auto variants = packed_variants(std::move(plan));
  std::vector<RestRecord> records;
  for (const Scene& scene : scenes) {
    std::vector<RestRecord> found;
    for (const auto& choice : variants) {
      found.push_back(
          time_to_rest(scene, choice,
                       part_of(progress, records.size() + found.size(), scenes.size() * variants.size(),
                               fmt::format("{}, {}", scene.settings.name, choice.method))));
    }
    each(scene, found);
    records.insert(records.end(), found.begin(), found.end());
  }
  return records;
}

void require_at_rest(const std::vector<RestRecord>& records) {
  const auto failed = std::count_if(records.begin(), records.end(), [](const auto& r) { return !r.times; });
  if (failed == 0) return;
  throw ComputationError(fmt::format("bench: {} of {} found no static equilibrium", failed, records.size()));
}

std::vector<SideBySide> bodies_all(const std::vector<Case>& cases, int bodies, BenchPlan plan,
                                   const ProgressOf& progress,
                                   const std::function<void(const std::vector<SideBySide>&)>& each) {
  if (plan.methods.empty()) {
    for (const MethodEntry& method : methods()) {
      if (method.packed_double.assemble_batch != nullptr) plan.methods.emplace_back(method.name);
    }
  }
  const int repetitions = plan.settings.repetitions;
  const auto variants = packed_variants(std::move(plan));
  std::vector<SideBySide> records;
  for (const Case& description : cases) {
    std::vector<SideBySide> found;
    for (const auto& choice : variants) {
      found.push_back(
          time_side_by_side(description, choice, static_cast<std::size_t>(bodies), repetitions,
                            part_of(progress, records.size() + found.size(), cases.size() * variants.size(),
                                    fmt::format("{}, {}", description.name, choice.method))));
    }
    each(found);
    records.insert(records.end(), found.begin(), found.end());
  }
  return records;
}

}  // namespace sandglass
