#include "commands/failure_maps.hpp"

#include <fmt/format.h>

#include "assembly/method_entry.hpp"
#include "base/error.hpp"
#include "commands/task_pool.hpp"
#include "comparison/verdict.hpp"
#include "stability/cell_files.hpp"

namespace sandglass {

namespace {

/// One cell to compute, unless a file has it.
struct Task {
  std::size_t map;
  std::string method;
  double x;
  double y;
};

std::vector<Map> make_maps(const MapPlan& plan, const Case& description) {
  std::vector<Map> maps;
  for (const auto& text : plan.maps) {
    maps.push_back(parse_map(text));
    require_possible(maps.back(), description);
  }
  if (maps.empty()) maps = usual_maps(description);
  for (const auto& text : plan.values) set_values(text, maps);
  return maps;
}

std::vector<std::string> make_methods(const MapPlan& plan) {
  for (const auto& name : plan.methods) method_named(name, "--methods");
  return plan.methods.empty() ? method_names() : plan.methods;
}

std::vector<Task> make_tasks(const std::vector<Map>& maps, const std::vector<std::string>& methods,
                             const Case& description) {
  std::vector<Task> tasks;
  for (std::size_t m = 0; m < maps.size(); ++m) {
    for (const auto& method : methods) {
      if (!concerns(maps[m], description, method)) continue;
      for (const double y : maps[m].ys) {
        for (const double x : maps[m].xs) tasks.push_back({m, method, x, y});
      }
    }
  }
  return tasks;
}

}  // namespace

void require_mappable(const Case& description) {
  if (description.quasi_static) return;
  throw InputError(
      fmt::format("{}: is a dynamic case; all maps, even of motion, start from a quasi-static case",
                  description.file.string()));
}

FailureMaps map_failures(const Case& description, const Scene& scene, const MapPlan& plan,
                         const Provenance& provenance, const ProgressOf& progress) {
  require_mappable(description);
  FailureMaps all{
      make_maps(plan, description), {}, good_limit(golden_to_truth(scene, read_references(scene)))};
  const auto tasks = make_tasks(all.maps, make_methods(plan), description);
  const CellFiles files(plan.folder, description, all.limit, provenance);
  Answers answers;
  std::vector<Cell> found(tasks.size());
  const bool complete = run_tasks(
      tasks.size(), plan.threads,
      [&](std::size_t n) {
        const auto& [m, method, x, y] = tasks[n];
        if (auto known = files.read(all.maps[m], method, x, y)) {
          found[n] = std::move(*known);
          return;
        }
        found[n] = compute_cell(all.maps[m], description, method, x, y, all.limit, answers);
        files.write(all.maps[m], found[n]);
      },
      progress);
  if (!complete) {
    throw ComputationError(fmt::format(
        "stability: interrupted; finished cells are in {}, and the same command resumes from there",
        plan.folder));
  }
  all.cells.resize(all.maps.size());
  for (std::size_t n = 0; n < tasks.size(); ++n) all.cells[tasks[n].map].push_back(std::move(found[n]));
  return all;
}

}  // namespace sandglass
