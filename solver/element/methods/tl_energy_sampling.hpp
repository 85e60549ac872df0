#pragma once

#include <string_view>

#include "element/hourglass_energy_sampling.hpp"
#include "element/method.hpp"
#include "element/one_point.hpp"

namespace sandglass {

struct TlEnergySampling : MethodWith<OnePoint, EnergySamplingControl> {
  static constexpr std::string_view name = "tl-energy-sampling";
  static constexpr std::string_view summary =
      "one point, Total Lagrangian, the missing part of the shear energy restored: no parameter";
};

}  // namespace sandglass
