#pragma once

#include <string_view>

#include "element/hourglass_assumed_strain.hpp"
#include "element/hourglass_form.hpp"
#include "element/one_point.hpp"

namespace sandglass {

struct TlAssumedStrain {
  static constexpr std::string_view name = "tl-assumed-strain";
  static constexpr std::string_view summary =
      "one point, Total Lagrangian, assumed strain of Belytschko and Bindeman (ASQBI), undeformed shape";
  using Kinematics = OnePoint;
  using Hourglass = ReferenceHourglassControl<AssumedStrain>;
};

}  // namespace sandglass
