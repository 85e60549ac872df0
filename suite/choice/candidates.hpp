#pragma once

#include <array>
#include <string_view>
#include <vector>

#include "assembly/method_entry.hpp"

/// What a method contributes to the ladder.
namespace sandglass {

/// Strengths of the hourglass control in addition to that of `auto`, as multiples of it: what is best for one
/// scene is within that.
inline constexpr std::array other_strengths{0.5, 2.0};

/// Accuracies that are tried with an adaptive method, as multiples of the user's tolerance: how near its
/// estimate of the error is to the error differs from scene to scene.
inline constexpr std::array accuracy_shares{4.0, 2.0, 1.0, 0.5, 0.25};

/// Why a method is no candidate for an answer at rest, or else for a motion; empty for one that is.
std::string_view unfit(const MethodEntry& method, bool at_rest);

/// The choices that a method contributes in the precision of `plain`.
std::vector<MethodChoice> choices_of(const MethodEntry& method, const MethodChoice& plain, const AnyLaw& law,
                                     double tolerance);

}  // namespace sandglass
