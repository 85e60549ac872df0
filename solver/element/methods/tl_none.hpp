#pragma once

#include <string_view>

#include "element/hourglass_none.hpp"
#include "element/method.hpp"
#include "element/one_point.hpp"

namespace sandglass {

struct TlNone : MethodWith<OnePoint, NoHourglassControl> {
  static constexpr std::string_view name = "tl-none";
  static constexpr std::string_view summary =
      "one point, Total Lagrangian, no hourglass control: fails visibly";
};

}  // namespace sandglass
