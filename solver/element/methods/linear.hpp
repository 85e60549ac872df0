#pragma once

#include <string_view>

#include "element/hourglass_perturbation.hpp"
#include "element/linear_one_point.hpp"

namespace sandglass {

struct LinearPerturbation {
  static constexpr std::string_view name = "linear";
  static constexpr std::string_view summary =
      "one point, small strain, perturbation hourglass control: right only while nothing turns or strains "
      "much";
  static constexpr int integration_points = 1;
  using Kinematics = LinearOnePoint;
  using Hourglass = PerturbationHourglassControl;
};

}  // namespace sandglass
