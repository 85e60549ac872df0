#pragma once

#include <string_view>

#include "element/hourglass_perturbation.hpp"
#include "element/one_point_forms.hpp"

namespace sandglass {

struct TlPerturbation {
  static constexpr std::string_view name = "tl-perturbation";
  static constexpr std::string_view summary =
      "one point, Total Lagrangian, perturbation hourglass control (the paper)";
  static constexpr bool batches = true;
  using Kinematics = OnePoint;
  using KinematicsOnParallelepipeds = ParallelepipedOnePoint;
  using Hourglass = PerturbationHourglassControl;
};

}  // namespace sandglass
