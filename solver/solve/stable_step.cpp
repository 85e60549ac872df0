#include "solve/stable_step.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/error.hpp"
#include "mesh/hexahedron.hpp"

namespace sandglass {

namespace {

double step_of(double square, const LoadRates& rates) {
  const auto& [added, a] = rates;
  const double sum = square + added;
  return a == 0.0 ? 2.0 / std::sqrt(sum) : (std::sqrt(a * a + 4.0 * sum) - a) / sum;
}

double square_of(const Model& model, std::size_t element, double stiffness) {
  return stiffness / share_of_node(model.element_masses()[element]);
}

double step_of(const Model& model, std::size_t element, double stiffness) {
  return step_of(square_of(model, element, stiffness),
                 model.load_rates().empty() ? LoadRates{} : model.load_rates()[element]);
}

/// Of bodies without loads that have rates: that of the largest square, which costs no roots.
StableStep step_without_rates(const Model& model, std::span<const double> bounds) {
  double most = 0.0;
  int element = -1;
  for (std::size_t e = 0; e < bounds.size(); ++e) {
    const double square = square_of(model, e, bounds[e]);
    if (square <= most) continue;
    most = square;
    element = static_cast<int>(e);
  }
  return {step_of(most, LoadRates{}), element};
}

}  // namespace

std::vector<double> stable_steps(const Model& model, std::vector<double> steps) {
  for (std::size_t e = 0; e < steps.size(); ++e) steps[e] = step_of(model, e, steps[e]);
  return steps;
}

StableStep stable_step(const Model& model, const NodalField& u) {
  std::vector<double> bounds(model.element_masses().size());
  std::visit(
      [&](const auto& elements) {
        auto state = state_at(*elements, u);
        auto force = state.u;
        elements->evaluate(state, force);  // forces of elements with history depend on it
        elements->stiffness_bounds(state, bounds);
      },
      model.internal_force());
  return stable_step(model, bounds);
}

StableStep stable_step(const Model& model, std::span<const double> bounds) {
  if (model.load_rates().empty()) return step_without_rates(model, bounds);
  StableStep smallest{std::numeric_limits<double>::infinity(), -1};
  for (std::size_t e = 0; e < bounds.size(); ++e) {
    const double step = step_of(model, e, bounds[e]);
    if (!(step >= smallest.step)) smallest = {step, static_cast<int>(e)};
  }
  return smallest;
}

void require_worthwhile(const StableStep& stable, double undeformed_step, double time, long step,
                        std::string_view part) {
  constexpr double least_share = 1e-3;
  if (stable.step >= least_share * undeformed_step) return;
  const bool by_damping = stable.element == StableStep::by_damping;
  throw ComputationError(fmt::format(
      "the stable step has collapsed at {:.6g} s, step {}: {} allows {:.3g} s, less than {} of the "
      "undeformed "
      "body's {:.3g} s; remedy: {}",
      time, step, by_damping ? "damping" : fmt::format("{} {}", part, stable.element), stable.step,
      least_share, undeformed_step,
      by_damping
          ? "damp less"
          : "impose less displacement or load, use a law that resists compression, or refine the mesh"));
}

double stable_step_of(const Model& model, double square) {
  LoadRates most;
  for (const auto& [added, damping] : model.load_rates()) {
    most.square = std::max(most.square, added);
    most.damping = std::max(most.damping, damping);
  }
  return step_of(square, most);
}

}  // namespace sandglass
