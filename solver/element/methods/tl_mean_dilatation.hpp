#pragma once

#include <string_view>

#include "element/eight_point.hpp"
#include "element/hourglass_none.hpp"
#include "element/method.hpp"

namespace sandglass {

struct TlMeanDilatation : MethodWith<EightPoint<MeanPressure>, NoHourglassControl, Batches> {
  static constexpr std::string_view name = "tl-mean-dilatation";
  static constexpr std::string_view summary =
      "eight points, one pressure per element: the golden's own element";
};

}  // namespace sandglass
