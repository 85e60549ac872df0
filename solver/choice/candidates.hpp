#pragma once

#include <array>
#include <string_view>
#include <type_traits>
#include <vector>

#include "element/methods.hpp"
#include "model/internal_force.hpp"

/// What a method contributes to the ladder, asked from its traits.
namespace sandglass {

/// Strengths of the hourglass control beside that of `auto`, as multiples of it: what is best for one scene
/// is within that.
inline constexpr std::array other_strengths{0.5, 2.0};

/// Accuracies that are tried with an adaptive method, as multiples of the user's tolerance: how near its
/// estimate of the error is to the error differs from scene to scene.
inline constexpr std::array accuracy_shares{4.0, 2.0, 1.0, 0.5, 0.25};

/// Why a method is no candidate; empty for one that is.
template <class Method>
constexpr std::string_view unfit() {
  using Hourglass = typename Method::Hourglass;
  if constexpr (DampsOnly<Hourglass>) {
    return "its hourglass control resists velocities alone: it has no answer at rest";
  } else if constexpr (Method::integration_points == 1 && std::is_same_v<Hourglass, NoHourglassControl>) {
    return "nothing resists its hourglass modes: a disturbance stays where it was put";
  } else {
    return "";
  }
}

/// The choices that a method contributes in one precision.
template <class Method>
std::vector<MethodChoice> choices_of(const MethodChoice& plain, const AnyLaw& law, double tolerance) {
  std::vector<MethodChoice> choices;
  if constexpr (is_adaptive<Method>) {
    for (const double share : accuracy_shares) {
      choices.push_back(plain);
      choices.back().accuracy = share * tolerance;
    }
    return choices;
  }
  choices.push_back(plain);
  if constexpr (kappa_matters_at_rest<Method>) {
    const double usual = auto_kappa(Method::name, law).value();
    for (const double strength : other_strengths) {
      choices.push_back(plain);
      choices.back().kappa = strength * usual;
    }
  }
  return choices;
}

}  // namespace sandglass
