#pragma once

#include <array>
#include <string_view>
#include <vector>

#include "assembly/method_entry.hpp"

/// The candidates of `choose` that a method adds.
namespace sandglass {

/// Further strengths of the hourglass control, as multiples of `auto`; the best one for a scene is in this
/// range.
inline constexpr std::array other_strengths{0.5, 2.0};

/// Accuracies tried with an adaptive method, as multiples of the user's tolerance; how close its error
/// estimate is differs from scene to scene.
inline constexpr std::array accuracy_shares{4.0, 2.0, 1.0, 0.5, 0.25};

/// Why a method is not a candidate for a static answer, or else for a motion; empty if it is.
std::string_view unfit(const MethodEntry& method, bool is_static);

/// The choices that a method adds in the precision of `plain`.
std::vector<MethodChoice> choices_of(const MethodEntry& method, const MethodChoice& plain, const AnyLaw& law,
                                     double tolerance);

}  // namespace sandglass
