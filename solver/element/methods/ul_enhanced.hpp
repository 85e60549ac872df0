#pragma once

#include <string_view>

#include "element/hourglass_enhanced.hpp"
#include "element/hourglass_rate.hpp"
#include "element/method.hpp"
#include "element/methods/tl_enhanced.hpp"
#include "element/updated_one_point.hpp"

namespace sandglass {

struct UlEnhanced
    : MethodWith<UpdatedOnePoint, RateHourglassControl<EnhancedStrain>, AtSmallStrainLike<TlEnhanced>> {
  static constexpr std::string_view name = "ul-enhanced";
  static constexpr std::string_view summary =
      "one point, Updated Lagrangian, enhanced assumed strain after Puso: ABAQUS's costlier control";
};

}  // namespace sandglass
