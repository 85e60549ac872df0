#include "stepping/forces.hpp"

#include <numeric>

#include "stepping/field.hpp"

namespace sandglass {

Forces::Forces(const Model& model)
    : model_(model), free_(model.masses().size()), reactions_(model.scene().constraints.size()) {}

void Forces::evaluate(const NodalField& u) {
  model_.internal_force().evaluate(u, free_);
  const auto& constraints = model_.scene().constraints;
  for (std::size_t c = 0; c < constraints.size(); ++c) {
    auto& component = free_[static_cast<std::size_t>(constraints[c].node)]
                           [static_cast<std::size_t>(constraints[c].component)];
    reactions_[c] = component;
    component = 0.0;
  }
}

double Forces::residual() const {
  const double unbalanced = std::sqrt(dot(free_, free_));
  const double carried =
      std::sqrt(std::inner_product(reactions_.begin(), reactions_.end(), reactions_.begin(), 0.0));
  return carried > 0.0 ? unbalanced / carried : unbalanced;
}

}  // namespace sandglass
