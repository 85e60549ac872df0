#include "choice/method_choices.hpp"

namespace sandglass {

std::string_view unfit(const MethodEntry& method, bool is_static) {
  if (method.is_condensed && !is_static) return "superposes static answers and cannot compute motions";
  if (method.damps_only && is_static)
    return "its hourglass control resists only velocities, so it has no static answer";
  if (!method.controls_hourglass) {
    return "does not resist hourglass modes: disturbances remain";
  }
  return "";
}

std::vector<MethodChoice> choices_of(const MethodEntry& method, const MethodChoice& plain, const AnyLaw& law,
                                     double tolerance) {
  std::vector<MethodChoice> choices;
  const auto add = [&](auto&& change) {
    choices.push_back(plain);
    change(choices.back());
  };
  if (method.adapts()) {
    for (const double share : accuracy_shares) {
      add([&](MethodChoice& choice) { choice.accuracy = share * tolerance; });
    }
    return choices;
  }
  choices.push_back(plain);
  if (method.kappa_affects_equilibrium) {
    const double usual = method.auto_kappa(elastic_law(kernel_law(law)), plain.kappa_modulus).value();
    for (const double strength : other_strengths) {
      add([&](MethodChoice& choice) { choice.kappa = strength * usual; });
    }
  }
  return choices;
}

}  // namespace sandglass
