#pragma once

#include <string_view>

#include "element/hourglass_enhanced.hpp"
#include "element/hourglass_form.hpp"
#include "element/method.hpp"
#include "element/one_point.hpp"

namespace sandglass {

struct TlEnhanced : MethodWith<OnePoint, ReferenceHourglassControl<EnhancedStrain>> {
  static constexpr std::string_view name = "tl-enhanced";
  static constexpr std::string_view summary =
      "one point, Total Lagrangian, enhanced assumed strain after Puso, undeformed shape";
};

}  // namespace sandglass
