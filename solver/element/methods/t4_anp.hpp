#pragma once

#include <string_view>

#include "element/hourglass_none.hpp"
#include "element/method.hpp"
#include "element/tetrahedra.hpp"

namespace sandglass {

struct T4Anp : MethodWith<Tetrahedra<NodalPressure>, NoHourglassControl> {
  static constexpr std::string_view name = "t4-anp";
  static constexpr std::string_view summary =
      "linear tetrahedra like t4, with pressures averaged at the nodes";
};

}  // namespace sandglass
