#pragma once

#include <string_view>

#include "element/hourglass_none.hpp"
#include "element/method.hpp"
#include "element/tetrahedra.hpp"

namespace sandglass {

struct T4 : MethodWith<Tetrahedra<OwnPressure>, NoHourglassControl> {
  static constexpr std::string_view name = "t4";
  static constexpr std::string_view summary =
      "linear tetrahedra, both cuts of a hexahedron into five: locks as nu -> 1/2";
};

}  // namespace sandglass
