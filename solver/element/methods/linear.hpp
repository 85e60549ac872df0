#pragma once

#include <string_view>

#include "element/hourglass_perturbation.hpp"
#include "element/linear_one_point.hpp"

namespace sandglass {

struct LinearPerturbation {
  static constexpr std::string_view name = "linear";
  static constexpr std::string_view summary =
      "one point, small strain, perturbation hourglass control: valid for small strains and rotations only";
  using Kinematics = LinearOnePoint;
  using Hourglass = PerturbationHourglassControl;
};

struct LinearCondensed {
  static constexpr std::string_view name = "linear-condensed";
  static constexpr std::string_view summary =
      "linear, solved once for all loads: answers are superposed from the response to unit displacements";
  static constexpr bool condensed = true;
  using SharesKernelsOf = LinearPerturbation;
  using Kinematics = LinearPerturbation::Kinematics;
  using Hourglass = LinearPerturbation::Hourglass;
};

}  // namespace sandglass
