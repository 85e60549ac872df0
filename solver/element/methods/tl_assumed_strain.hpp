#pragma once

#include <string_view>

#include "element/hourglass_assumed_strain.hpp"
#include "element/hourglass_form.hpp"
#include "element/method.hpp"
#include "element/one_point.hpp"

namespace sandglass {

struct TlAssumedStrain : MethodWith<OnePoint, ReferenceHourglassControl<AssumedStrain>> {
  static constexpr std::string_view name = "tl-assumed-strain";
  static constexpr std::string_view summary =
      "one point, Total Lagrangian, assumed strain of Belytschko and Bindeman (ASQBI), undeformed shape";
};

}  // namespace sandglass
