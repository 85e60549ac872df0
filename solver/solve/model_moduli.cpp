#include "solve/model_moduli.hpp"

#include <algorithm>

#include "assembly/method_entry.hpp"
#include "element/perturbation_stiffness.hpp"

namespace sandglass {

namespace {

/// The grids do not see the stiffness of hourglass modes: a model with the full stiffness of a strong control
/// converges more slowly than one with E/9, with which cubes bend correctly. If volume changes are resisted
/// at several points of an element, somewhat more helps, in shares of E/9.
constexpr double strongest_resistance = 16.0;

/// The pressures carry lambda (J - 1), with lambda at least this share of mu: if Poisson's ratio is zero or
/// less, they would carry nothing, and 1 / lambda has no value. Any share is admissible.
constexpr double least_lambda_over_mu = 0.1;

}  // namespace

std::vector<ModelModuli> model_moduli(const Model& model) {
  const MethodChoice& choice = model.choice();
  const MethodEntry& method = method_named(choice.method);
  HourglassSettings settings;
  if (method.kappa_affects_equilibrium)
    settings = {.kappa = choice.kappa, .kappa_modulus = choice.kappa_modulus};
  const auto moduli = [&](const auto& law) {
    const double lambda = std::max(lame_lambda(law), least_lambda_over_mu * law.shear_modulus());
    const double unit = young_modulus(law) / 9.0;
    const double control = std::min(PerturbationStiffness::modulus(law, settings), unit);
    const double resistance = std::min(unit + lambda / 9.0, strongest_resistance * unit);
    return ModelModuli{lambda, law.shear_modulus(), method.pressure_varies ? resistance : control,
                       method.integration_points > 1};
  };
  return by_material(model.scene().materials,
                     [&](const Material& material) { return std::visit(moduli, material.law); });
}

}  // namespace sandglass
