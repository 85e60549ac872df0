#pragma once

#include <string_view>

#include "element/four_point.hpp"
#include "element/hourglass_sampling.hpp"
#include "element/method.hpp"

namespace sandglass {

struct TlFourPoint : MethodWith<FourPoint, LastModeControl> {
  static constexpr std::string_view name = "tl-four-point";
  static constexpr std::string_view summary =
      "four points on the element's mean parallelepiped, one pressure: nearly as good as eight, with one "
      "point's memory";
};

}  // namespace sandglass
