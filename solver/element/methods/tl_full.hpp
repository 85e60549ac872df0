#pragma once

#include <string_view>

#include "element/eight_point.hpp"
#include "element/hourglass_none.hpp"

namespace sandglass {

struct TlFull {
  static constexpr std::string_view name = "tl-full";
  static constexpr std::string_view summary = "eight points, displacement element: locks as nu -> 1/2";
  using Kinematics = EightPoint<PointPressure>;
  using Hourglass = NoHourglassControl;
};

}  // namespace sandglass
