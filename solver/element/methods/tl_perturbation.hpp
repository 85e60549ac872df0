#pragma once

#include <string_view>

#include "element/hourglass_perturbation.hpp"
#include "element/one_point.hpp"

namespace sandglass {

struct TlPerturbation {
  static constexpr std::string_view name = "tl-perturbation";
  static constexpr std::string_view summary =
      "one point, Total Lagrangian, perturbation hourglass control (the paper)";
  static constexpr int integration_points = 1;
  using Kinematics = OnePoint;
  using Hourglass = PerturbationHourglassControl;
};

}  // namespace sandglass
