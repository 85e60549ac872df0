#pragma once

#include <string_view>

#include "element/hourglass_perturbation.hpp"
#include "element/linear_one_point.hpp"

namespace sandglass {

struct LinearCondensed {
  static constexpr std::string_view name = "linear-condensed";
  static constexpr std::string_view summary =
      "linear, solved once for all loads: answers are superposed from the response to unit displacements";
  static constexpr int integration_points = 1;
  static constexpr bool condensed = true;
  using Kinematics = LinearOnePoint;
  using Hourglass = PerturbationHourglassControl;
};

}  // namespace sandglass
