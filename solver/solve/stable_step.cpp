#include "solve/stable_step.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace sandglass {

namespace {

double step_of(double stiffness, double mass) {
  return 2.0 / std::sqrt(stiffness / (mass / 8.0));
}

std::vector<double> stiffness_bounds(const Model& model, const NodalField& u) {
  std::vector<double> bounds(model.element_masses().size());
  std::visit(
      [&](const auto& elements) {
        auto state = state_at(*elements, u);
        auto force = state.u;
        elements->evaluate(state, force);  // forces of elements with history depend on it
        elements->stiffness_bounds(state, bounds);
      },
      model.internal_force());
  return bounds;
}

}  // namespace

std::vector<double> stable_steps(const Model& model, const NodalField& u) {
  std::vector<double> steps = stiffness_bounds(model, u);
  for (std::size_t e = 0; e < steps.size(); ++e) steps[e] = step_of(steps[e], model.element_masses()[e]);
  return steps;
}

StableStep stable_step(const Model& model, const NodalField& u) {
  return stable_step(model, stiffness_bounds(model, u));
}

StableStep stable_step(const Model& model, std::span<const double> bounds) {
  StableStep smallest{std::numeric_limits<double>::infinity(), -1};
  for (std::size_t e = 0; e < bounds.size(); ++e) {
    const double step = step_of(bounds[e], model.element_masses()[e]);
    if (!(step >= smallest.step)) smallest = {step, static_cast<int>(e)};
  }
  return smallest;
}

}  // namespace sandglass
