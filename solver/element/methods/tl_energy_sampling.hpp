#pragma once

#include <string_view>

#include "element/hourglass_energy_sampling.hpp"
#include "element/one_point.hpp"

namespace sandglass {

struct TlEnergySampling {
  static constexpr std::string_view name = "tl-energy-sampling";
  static constexpr std::string_view summary =
      "one point, Total Lagrangian, the missing part of the shear energy restored: no parameter";
  using Kinematics = OnePoint;
  using Hourglass = EnergySamplingControl;
};

}  // namespace sandglass
