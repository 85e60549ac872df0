#include "choice/cost.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "assembly/method_entry.hpp"
#include "base/error.hpp"
#include "benchmark/condensed_model.hpp"
#include "benchmark/machine_speed.hpp"
#include "benchmark/statistics.hpp"

namespace sandglass {

namespace {

constexpr int repetitions = 10;

/// A model with the forces it is compared with: its own, which tells that they are numbers.
struct Timed {
  std::size_t rung;
  std::unique_ptr<SteppedModel> model;
  NodalField forces;

  Entry entry() const { return {model.get(), &forces, 1.0}; }
};

std::string first_line(const std::string& text) {
  return text.substr(0, text.find('\n'));
}

/// The model of a rung, which has stepped for a while without harm: from where the reference is, or, where a
/// method cannot stand there, from waves. Throws InputError or ComputationError.
Timed make_timed(const Rung& rung, std::size_t number, const Proceed& proceed) {
  const Scene& scene = rung.mesh->scene;
  if (method_named(rung.choice.method).is_condensed && scene.mesh.points.size() > most_condensed_nodes) {
    throw InputError(fmt::format("to factorise for {} nodes takes too long; at most {} here",
                                 scene.mesh.points.size(), most_condensed_nodes));
  }
  const auto rehearsed = [&](const NodalField* start) {
    Timed timed{number, make_stepped_model(scene, rung.choice, start), {}};
    timed.forces = timed.model->forces();
    const Entry entry = timed.entry();
    const auto timings = measure(std::span(&entry, 1), {.repetitions = 0}, proceed);
    if (timings[0].status != "ok") throw ComputationError(timings[0].status);
    return timed;
  };
  try {
    return rehearsed(&rung.mesh->farthest());
  } catch (const ComputationError&) {
    if (!proceed(0.0)) throw;
    return rehearsed(nullptr);
  }
}

/// The step that a real-time loop takes; none where there are no steps.
std::optional<double> step_size(const Rung& rung, const SteppedModel& model) {
  const auto deformed = model.stable_step();
  if (!deformed) return std::nullopt;
  const Scene& scene = rung.mesh->scene;
  const NodalField zero(scene.mesh.points.size());
  const double stable = std::min(*deformed, *make_stepped_model(scene, rung.choice, &zero)->stable_step());
  return scene.description.dynamics.step_fraction * stable;
}

/// Times models that are in memory together.
void time_together(const std::vector<Timed>& group, std::vector<Costing>& costings, const Proceed& proceed) {
  std::vector<Entry> entries;
  for (const auto& timed : group) entries.push_back(timed.entry());
  const auto timings = measure(entries, {.repetitions = repetitions}, proceed);
  for (std::size_t n = 0; n < group.size(); ++n) {
    Costing& costing = costings[group[n].rung];
    costing.cost->seconds = spread_of(timings[n].seconds_per_step).median;
  }
}

}  // namespace

double Cost::per_simulated_second() const {
  return step_size ? seconds / *step_size : seconds * answers_per_second;
}

std::vector<Costing> measure_costs(std::span<const Rung> rungs, const Proceed& proceed) {
  std::vector<Costing> costings(rungs.size());
  std::vector<std::size_t> twin(rungs.size());
  std::vector<Timed> group;
  const double room = 0.5 * static_cast<double>(available_memory());
  double taken = 0.0;
  for (std::size_t n = 0; n < rungs.size(); ++n) {
    const auto same = [&](const Rung& other) { return same_work(other, rungs[n]); };
    twin[n] = static_cast<std::size_t>(std::find_if(rungs.begin(), rungs.end(), same) - rungs.begin());
    if (twin[n] != n || !rungs[n].unfit.empty()) continue;
    try {
      group.push_back(make_timed(rungs[n], n, proceed));
      costings[n].cost = Cost{0.0, step_size(rungs[n], *group.back().model)};
    } catch (const InputError& error) {
      costings[n].status = first_line(error.what());
      continue;
    } catch (const ComputationError& error) {
      if (!proceed(0.0)) throw;
      costings[n].status = first_line(error.what());
      continue;
    }
    const auto elements = static_cast<double>(rungs[n].mesh->scene.mesh.cells.size());
    taken += 2.0 * group.back().model->work().bytes * elements;
    if (taken < room) continue;
    time_together(group, costings, proceed);
    group.clear();
    taken = 0.0;
  }
  time_together(group, costings, proceed);
  for (std::size_t n = 0; n < rungs.size(); ++n) costings[n] = costings[twin[n]];
  return costings;
}

}  // namespace sandglass
