#pragma once

#include <string_view>

#include "element/hourglass_perturbation.hpp"
#include "element/linear_one_point.hpp"
#include "element/method.hpp"

namespace sandglass {

struct Linear : MethodWith<LinearOnePoint, PerturbationHourglassControl> {
  static constexpr std::string_view name = "linear";
  static constexpr std::string_view summary =
      "one point, small strain, perturbation hourglass control: valid for small strains and rotations only";
};

}  // namespace sandglass
