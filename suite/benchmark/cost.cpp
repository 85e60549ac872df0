#include "benchmark/cost.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "assembly/method_entry.hpp"
#include "base/error.hpp"
#include "base/memory.hpp"
#include "benchmark/condensed_model.hpp"
#include "benchmark/machine_speed.hpp"
#include "benchmark/statistics.hpp"

namespace sandglass {

namespace {

constexpr int repetitions = 20;

/// A model and its reference forces. These are its own, so that the comparison only shows that they are
/// finite.
struct Timed {
  std::size_t task;
  std::unique_ptr<SteppedModel> model;
  NodalField forces;

  Entry entry() const { return {model.get(), &forces, 1.0}; }
};

std::string first_line(const std::string& text) {
  return text.substr(0, text.find('\n'));
}

/// Whether two tasks do the same work in a step: kappa does not change it.
bool same_work(const MethodChoice& a, const MethodChoice& b) {
  return a.method == b.method && a.precision == b.precision && a.accuracy == b.accuracy &&
         a.threads == b.threads;
}

/// The model of a task, after a batch of steps has shown that it works. Throws InputError or
/// ComputationError.
Timed make_timed(const CostTask& task, std::size_t number, const Proceed& proceed) {
  const std::size_t nodes = task.scene->mesh.points.size();
  if (method_named(task.choice.method).is_condensed && nodes > most_condensed_nodes) {
    throw InputError(fmt::format("factorising {} nodes takes too long; at most {} are timed", nodes,
                                 most_condensed_nodes));
  }
  Timed timed{number, make_stepped_model(*task.scene, task.choice, task.motion), {}};
  timed.forces = timed.model->forces();
  const Entry entry = timed.entry();
  const auto timings = measure(std::span(&entry, 1), {.repetitions = 0}, proceed);
  if (timings[0].status != "ok") throw ComputationError(timings[0].status);
  return timed;
}

/// Times models that are in memory at the same time.
void time_together(std::span<const CostTask> tasks, std::vector<Timed>& group, std::vector<Costing>& costings,
                   const Proceed& proceed) {
  std::vector<Entry> entries;
  for (const auto& timed : group) entries.push_back(timed.entry());
  const auto timings = measure(entries, {.repetitions = repetitions}, proceed);
  for (std::size_t n = 0; n < group.size(); ++n) {
    StepCost& cost = *costings[group[n].task].cost;
    const Spread seconds = spread_of(timings[n].seconds_per_step);
    cost.seconds = seconds.median;
    cost.lower_quartile = seconds.lower_quartile;
    cost.upper_quartile = seconds.upper_quartile;
    const CostTask& task = tasks[group[n].task];
    cost.checks = checks_per_step(timings[n], *task.scene, task.motion);
  }
  group.clear();
}

}  // namespace

double checks_per_step(const Timing& timing, const Scene& scene, const OwnMotion* motion) {
  const double check = spread_of(timing.seconds_of_a_check).median;
  return check / scene.settings.dynamics.check_interval + (motion != nullptr ? motion->adaption : 0.0);
}

std::vector<Costing> measure_costs(std::span<const CostTask> tasks, const Proceed& proceed) {
  std::vector<Costing> costings(tasks.size());
  std::vector<std::size_t> original(tasks.size());
  std::vector<Timed> group;
  const double room = 0.5 * static_cast<double>(available_memory());
  double taken = 0.0;
  for (std::size_t n = 0; n < tasks.size(); ++n) {
    const auto same = [&](const CostTask& other) {
      return other.scene == tasks[n].scene && same_work(other.choice, tasks[n].choice);
    };
    original[n] = static_cast<std::size_t>(std::find_if(tasks.begin(), tasks.end(), same) - tasks.begin());
    if (original[n] != n) continue;
    try {
      group.push_back(make_timed(tasks[n], n, proceed));
    } catch (const InputError& error) {
      costings[n].status = first_line(error.what());
      continue;
    } catch (const ComputationError& error) {
      if (!proceed(0.0)) throw;
      costings[n].status = first_line(error.what());
      continue;
    }
    costings[n].cost = StepCost{.condensed = method_named(tasks[n].choice.method).is_condensed};
    const auto elements = static_cast<double>(tasks[n].scene->mesh.cells.size());
    taken += 2.0 * group.back().model->work().bytes * elements;
    if (taken < room) continue;
    time_together(tasks, group, costings, proceed);
    taken = 0.0;
  }
  time_together(tasks, group, costings, proceed);
  for (std::size_t n = 0; n < tasks.size(); ++n) {
    costings[n] = costings[original[n]];
    if (!costings[n].cost || tasks[n].motion == nullptr) continue;
    costings[n].cost->mean_step = tasks[n].motion->mean_step;
    costings[n].cost->remark = tasks[n].motion->remark;
  }
  return costings;
}

}  // namespace sandglass
