#pragma once

#include <string_view>

#include "element/hourglass_assumed_strain.hpp"
#include "element/hourglass_rate.hpp"
#include "element/method.hpp"
#include "element/methods/tl_assumed_strain.hpp"
#include "element/updated_one_point.hpp"

namespace sandglass {

struct UlAssumedStrain
    : MethodWith<UpdatedOnePoint, RateHourglassControl<AssumedStrain>, AtSmallStrainLike<TlAssumedStrain>> {
  static constexpr std::string_view name = "ul-assumed-strain";
  static constexpr std::string_view summary =
      "one point, Updated Lagrangian, assumed strain (ASQBI) of the current shape: LS-DYNA's type 6";
};

}  // namespace sandglass
