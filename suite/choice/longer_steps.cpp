#include "choice/longer_steps.hpp"

#include <fmt/format.h>

#include <cmath>

namespace sandglass {

namespace {

constexpr double smallest_ratio = 0.25;

/// Softens the law against changes of volume; returns whether that was possible.
template <class Law>
bool soften(Law& law, double factor) {
  if constexpr (requires { law.young_modulus, law.poisson_ratio; }) {
    constexpr double digits = 1e9;
    const double softer = std::round(digits * (0.5 - factor * (0.5 - law.poisson_ratio))) / digits;
    if (softer < smallest_ratio) return false;
    law.young_modulus *= std::sqrt((1.0 + law.poisson_ratio) / (1.0 + softer));
    law.poisson_ratio = softer;
    return true;
  }
  return false;
}

}  // namespace

std::vector<LongerSteps> longer_steps(const CaseOnMesh& problem) {
  CaseOnMesh longer = problem;
  if (longer.description.dynamics.subcycles > 1) return {};
  std::vector<LongerSteps> found;
  if (int& body_frequency = longer.description.dynamics.body_frequency; body_frequency == 0) {
    body_frequency = 1;
    found.push_back({"body_frequency", longer});
  }
  for (const double factor : {1.5, 2.5, 5.0, 10.0}) {
    CaseOnMesh softer = longer;
    bool softened = false;
    for (auto& material : softer.description.materials) {
      softened |= std::visit([&](auto& law) { return soften(law, factor); }, material.law);
    }
    if (!softened) break;
    found.push_back({fmt::format("body_frequency, bulk / {:.2g}", factor), std::move(softer)});
  }
  return found;
}

}  // namespace sandglass
