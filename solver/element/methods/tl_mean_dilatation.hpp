#pragma once

#include <string_view>

#include "element/eight_point.hpp"
#include "element/hourglass_none.hpp"

namespace sandglass {

struct TlMeanDilatation {
  static constexpr std::string_view name = "tl-mean-dilatation";
  static constexpr std::string_view summary =
      "eight points, one pressure per element: the golden's own element";
  static constexpr bool batches = true;
  using Kinematics = EightPoint<MeanPressure>;
  using Hourglass = NoHourglassControl;
};

}  // namespace sandglass
