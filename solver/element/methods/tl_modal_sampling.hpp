#pragma once

#include <string_view>

#include "element/hourglass_sampling.hpp"
#include "element/one_point.hpp"

namespace sandglass {

struct TlModalSampling {
  static constexpr std::string_view name = "tl-modal-sampling";
  static constexpr std::string_view summary =
      "one point, Total Lagrangian, a stiffness for each hourglass mode from its shear energy: no parameter";
  using Kinematics = OnePoint;
  using Hourglass = ModalSamplingControl;
};

}  // namespace sandglass
