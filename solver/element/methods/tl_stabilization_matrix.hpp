#pragma once

#include <string_view>

#include "element/one_point.hpp"
#include "element/stabilization_matrix.hpp"

namespace sandglass {

struct TlStabilizationMatrix {
  static constexpr std::string_view name = "tl-stabilization-matrix";
  static constexpr std::string_view summary =
      "one point, Total Lagrangian, the stiffness that the mean-dilatation element adds when undeformed";
  using Kinematics = OnePoint;
  using Hourglass = StabilizationMatrixControl;
};

}  // namespace sandglass
