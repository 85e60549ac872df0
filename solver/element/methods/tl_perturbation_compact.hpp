#pragma once

#include <string_view>

#include "element/hourglass_perturbation.hpp"
#include "element/method.hpp"
#include "element/one_point_forms.hpp"

namespace sandglass {

struct TlPerturbationCompact : MethodWith<CompactOnePoint, PerturbationHourglassControl> {
  static constexpr std::string_view name = "tl-perturbation-compact";
  static constexpr std::string_view summary =
      "tl-perturbation with its geometry recomputed in each step instead of loaded";
};

}  // namespace sandglass
