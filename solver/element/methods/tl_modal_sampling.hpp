#pragma once

#include <string_view>

#include "element/hourglass_sampling.hpp"
#include "element/method.hpp"
#include "element/one_point.hpp"

namespace sandglass {

struct TlModalSampling : MethodWith<OnePoint, ModalSamplingControl> {
  static constexpr std::string_view name = "tl-modal-sampling";
  static constexpr std::string_view summary =
      "one point, Total Lagrangian, a stiffness for each hourglass mode from its shear energy: no parameter";
};

}  // namespace sandglass
