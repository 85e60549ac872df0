#pragma once

#include <string_view>

#include "element/methods/linear.hpp"

namespace sandglass {

struct LinearCondensed
    : MethodWith<Linear::Kinematics, Linear::Hourglass, Condensed, SharesKernelsOf<Linear>> {
  static constexpr std::string_view name = "linear-condensed";
  static constexpr std::string_view summary =
      "linear, solved once for all loads: superposes the response to unit displacements";
};

}  // namespace sandglass
