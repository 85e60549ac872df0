#pragma once

#include <string_view>

#include "element/hourglass_none.hpp"
#include "element/one_point.hpp"

namespace sandglass {

struct TlNone {
  static constexpr std::string_view name = "tl-none";
  static constexpr std::string_view summary =
      "one point, Total Lagrangian, no hourglass control: fails visibly";
  using Kinematics = OnePoint;
  using Hourglass = NoHourglassControl;
};

}  // namespace sandglass
