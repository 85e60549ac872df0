#pragma once

#include <fmt/format.h>

#include <optional>
#include <string>

#include "comparison/accuracy.hpp"

namespace sandglass {

/// A fraction as a percentage with three digits; "-" if there is none.
inline std::string percent(const std::optional<double>& fraction) {
  return fraction ? fmt::format("{:.3g}", 100.0 * *fraction) : "-";
}

/// The largest error, the largest along the profile and the root mean square, in three columns of nine
/// characters.
inline std::string percents(const std::optional<Accuracy>& accuracy) {
  if (!accuracy) return fmt::format("{:>9}{:>9}{:>9}", "-", "-", "-");
  return fmt::format("{:>9}{:>9}{:>9}", percent(accuracy->max_relative_error),
                     percent(accuracy->profile_relative_error), percent(accuracy->rms_relative_error));
}

}  // namespace sandglass
