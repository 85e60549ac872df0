#include "sandglass/driven_problem.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/error.hpp"
#include "base/names.hpp"
#include "device/opencl_processor.hpp"
#include "forces/contact_force.hpp"
#include "io/case_file.hpp"
#include "solve/leapfrog.hpp"

namespace sandglass {

namespace {

/// The driven components of each set: those imposed on it; of other sets, those of their nodes. Obstacles are
/// sets of one node.
std::map<std::string, std::vector<Driven>> driven_sets(const Scene& scene) {
  std::map<std::string, std::vector<Driven>> driven;
  for (const auto& [name, nodes] : scene.sets) {
    const auto own = std::ranges::find(scene.driven, name, &DrivenSet::name);
    for_each_constraint(scene.constraints, nodes, [&, &set = name](std::size_t k, std::size_t n) {
      if (own == scene.driven.end() || std::ranges::binary_search(own->constraints, k))
        driven[set].push_back({k, n, at(scene.constraints[k].component)});
    });
  }
  std::size_t next = scene.constraints.size();
  for (const Movable& obstacle : movable_of(scene.forces)) {
    for (std::size_t i = 0; i < 3; ++i) driven[std::string(obstacle.name)].push_back({next++, 0, i});
  }
  return driven;
}

template <class Sets>
const typename Sets::mapped_type& find(const Sets& sets, const std::string& name, const char* rule) {
  const auto found = sets.find(name);
  if (found != sets.end()) return found->second;
  throw InputError(fmt::format("set '{}' {}; {}", name, rule, suggestion(name, names_in(sets))));
}

double step_fraction_of(const CaseSettings& of_case, const SimulationSettings& settings) {
  return settings.step_fraction.value_or(of_case.dynamics.step_fraction);
}

MethodChoice choice_of(const CaseSettings& of_case, const SimulationSettings& settings, Precision precision) {
  require_in_range("step_fraction", step_fraction_of(of_case, settings),
                   {.low = 0.0, .high = 1.0, .high_open = false});
  require_in_range("damping", settings.damping.value_or(0.0), Range::at_least(0.0));
  MethodChoice choice = method_of(of_case, settings.method);
  if (settings.kappa) choice.kappa = settings.kappa;
  choice.precision = precision;
  choice.threads = settings.threads;
  choice.processor = processor_named(settings.device, "device");
  return choice;
}

}  // namespace

DrivenProblem::DrivenProblem(Scene scene, const SimulationSettings& settings, Precision precision)
    : scene_(in_motion(std::move(scene))),
      model_(scene_, choice_of(scene_.settings, settings, precision)),
      driven_(driven_sets(scene_)),
      targets_(scene_.constraints.size() + 3 * movable_of(scene_.forces).size()),
      damping_(settings.damping.value_or(scene_.settings.dynamics.damping)),
      step_fraction_(step_fraction_of(scene_.settings, settings)) {
  require_steps(model_);
}

const std::vector<Driven>& DrivenProblem::driven(const std::string& set) const {
  return find(driven_, set, "has no driven node: the case imposes no displacement on it");
}

const std::vector<int>& DrivenProblem::nodes(const std::string& set) const {
  return find(scene_.sets, set, "is not known");
}

void DrivenProblem::require_one_for_each_node(const std::string& set, std::size_t count) const {
  if (std::ranges::any_of(movable_of(scene_.forces), [&](const Movable& one) { return one.name == set; })) {
    throw InputError(fmt::format("obstacle '{}': {} displacements; allowed: one", set, count));
  }
  if (count == nodes(set).size()) return;
  throw InputError(fmt::format("set '{}': {} displacements; it must be one for each of its {} nodes", set,
                               count, nodes(set).size()));
}

namespace {

/// Sorts sets of numbers below `count`.
void sort_sets(std::map<std::string, std::vector<int>>& sets, const char* set, const char* member,
               std::size_t count) {
  for (auto& [name, members] : sets) {
    for (const int number : members) {
      if (number >= 0 && at(number) < count) continue;
      throw InputError(
          fmt::format("mesh: {} '{}' names {} {}; it must be in [0, {})", set, name, member, number, count));
    }
    std::sort(members.begin(), members.end());
    members.erase(std::unique(members.begin(), members.end()), members.end());
  }
}

}  // namespace

MeshWithSets checked(MeshArrays arrays) {
  sort_sets(arrays.sets, "set", "node", arrays.points.size());
  sort_sets(arrays.element_sets, "element set", "element", arrays.cells.size());
  std::vector<bool> met(arrays.points.size(), false);
  for (std::size_t n = 0; n < arrays.points.size(); ++n) {
    for (const double x : arrays.points[n]) {
      if (!std::isfinite(x)) throw InputError(fmt::format("mesh: node {} is at {}; it must be finite", n, x));
    }
  }
  for (std::size_t e = 0; e < arrays.cells.size(); ++e) {
    for (const int node : arrays.cells[e]) {
      if (node < 0 || at(node) >= met.size()) {
        throw InputError(
            fmt::format("mesh: cell {} names node {}; it must be in [0, {})", e, node, met.size()));
      }
      met[at(node)] = true;
    }
  }
  const auto alone = std::find(met.begin(), met.end(), false);
  if (met.empty() || alone != met.end()) {
    throw InputError(fmt::format(
        "mesh: node {} of {} belongs to no cell; each node must belong to one, and there must be nodes",
        std::distance(met.begin(), alone), met.size()));
  }
  return {{std::move(arrays.points), std::move(arrays.cells)},
          std::move(arrays.sets),
          std::move(arrays.element_sets)};
}

void require_in_range(const char* name, double value, const Range& range) {
  if (!range.contains(value))
    throw InputError(fmt::format("{} = {} must be in {}", name, value, range.text()));
}

double steps_in(double seconds, double step) {
  constexpr double rounding = 1e-9, most = 0x1p53;  // of a step; beyond, a step no longer changes the time
  if (!(seconds / step < most)) {
    throw InputError(
        fmt::format("seconds = {} must be less than 2^53 steps, of {} s at present", seconds, step));
  }
  return std::max(1.0, std::ceil(seconds / step - rounding));
}

}  // namespace sandglass
