#pragma once

#include <string_view>

#include "element/hourglass_enhanced.hpp"
#include "element/hourglass_form.hpp"
#include "element/one_point.hpp"

namespace sandglass {

struct TlEnhanced {
  static constexpr std::string_view name = "tl-enhanced";
  static constexpr std::string_view summary =
      "one point, Total Lagrangian, enhanced assumed strain after Puso, undeformed shape";
  static constexpr int integration_points = 1;
  using Kinematics = OnePoint;
  using Hourglass = ReferenceHourglassControl<EnhancedStrain>;
};

}  // namespace sandglass
