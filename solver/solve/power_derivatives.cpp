#include "solve/power_derivatives.hpp"

#include <algorithm>

#include "solve/law_parameters.hpp"

namespace sandglass {

namespace {

State<double> state_of(const InternalForce<double>& elements, const std::vector<double>& levels) {
  State<double> state = elements.undeformed();
  if (!levels.empty()) elements.set_levels(state, levels);
  return state;
}

}  // namespace

PowerDerivativeSum::PowerDerivativeSum(const Model& model, const std::vector<double>& levels,
                                       bool of_parameters)
    : model_(model),
      state_(state_of(double_elements(model), levels)),
      powers_(model.scene().mesh.cells.size()) {
  sum_.scales.resize(powers_.size());
  if (!of_parameters) return;
  const Materials& own = model.scene().materials;
  const auto steps = by_material(own, [](const Material& material) { return parameter_steps(material.law); });
  std::size_t most = 0;
  for (const auto& each : steps) {
    sum_.parameters.emplace_back(each.size(), 0.0);
    most = std::max(most, each.size());
  }
  for (std::size_t k = 0; k < most; ++k) {  // all materials together, as an element has one
    for (const bool upwards : {false, true}) {
      const auto moves = [&](std::size_t m) { return k < steps[m].size() && steps[m][k].upwards == upwards; };
      for (const auto& [offset, weight] : difference_formula(upwards)) {
        Materials materials = own;
        std::vector<double> weights(steps.size());
        for (std::size_t m = 0; m < steps.size(); ++m) {
          if (!moves(m)) continue;
          std::vector<double> by(steps[m].size(), 0.0);
          by[k] = offset * steps[m][k].length;
          materials.list[m].law = with_moved_parameters(own.list[m].law, by);
          weights[m] = weight / steps[m][k].length;
        }
        if (std::ranges::count(weights, 0.0) == std::ssize(weights)) continue;
        auto elements = std::get<std::unique_ptr<InternalForce<double>>>(
            make_internal_force(model.scene().mesh, materials, model.choice()));
        State<double> state = state_of(*elements, levels);
        variants_.push_back({std::move(elements), std::move(state), k, std::move(weights)});
      }
    }
  }
}

void PowerDerivativeSum::add(const Rows<double>& u, const Rows<double>& v) {
  const Materials& materials = model_.scene().materials;
  state_.u = u;
  double_elements(model_).powers(state_, v, powers_);
  for (std::size_t e = 0; e < powers_.size(); ++e) sum_.scales[e] += powers_[e];
  for (auto& [elements, state, parameter, weights] : variants_) {
    state.u = u;
    elements->powers(state, v, powers_);
    for (std::size_t e = 0; e < powers_.size(); ++e) {
      const std::size_t m = materials.of(e);
      if (weights[m] != 0.0) sum_.parameters[m][parameter] += weights[m] * powers_[e];
    }
  }
}

}  // namespace sandglass
