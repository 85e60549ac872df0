#pragma once

#include <string_view>

#include "element/hourglass_rate_perturbation.hpp"
#include "element/method.hpp"
#include "element/methods/tl_perturbation.hpp"
#include "element/updated_one_point.hpp"

namespace sandglass {

struct UlPerturbation
    : MethodWith<UpdatedOnePoint, RatePerturbationControl, AtSmallStrainLike<TlPerturbation>> {
  static constexpr std::string_view name = "ul-perturbation";
  static constexpr std::string_view summary =
      "one point, Updated Lagrangian, perturbation control integrated in time and rotated, as in ABAQUS";
};

}  // namespace sandglass
