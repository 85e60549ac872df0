#include "stepping/stable_step.hpp"

#include <algorithm>
#include <cmath>

namespace sandglass {

std::vector<double> stable_steps(const Model& model, const NodalField& u) {
  const auto& masses = model.element_masses();
  std::vector<double> steps(masses.size());
  model.internal_force().stiffness_bounds(u, steps);
  for (std::size_t e = 0; e < steps.size(); ++e) steps[e] = 2.0 / std::sqrt(steps[e] / (masses[e] / 8.0));
  return steps;
}

StableStep stable_step(const Model& model, const NodalField& u) {
  const auto steps = stable_steps(model, u);
  const auto smallest = std::min_element(steps.begin(), steps.end());
  return {*smallest, static_cast<int>(smallest - steps.begin())};
}

}  // namespace sandglass
