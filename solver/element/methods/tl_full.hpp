#pragma once

#include <string_view>

#include "element/eight_point.hpp"
#include "element/hourglass_none.hpp"
#include "element/method.hpp"

namespace sandglass {

struct TlFull : MethodWith<EightPoint<PointPressure>, NoHourglassControl> {
  static constexpr std::string_view name = "tl-full";
  static constexpr std::string_view summary = "eight points, displacement element: locks as nu -> 1/2";
};

}  // namespace sandglass
