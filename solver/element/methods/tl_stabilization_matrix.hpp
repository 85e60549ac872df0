#pragma once

#include <string_view>

#include "element/method.hpp"
#include "element/one_point.hpp"
#include "element/stabilization_matrix.hpp"

namespace sandglass {

struct TlStabilizationMatrix : MethodWith<OnePoint, StabilizationMatrixControl> {
  static constexpr std::string_view name = "tl-stabilization-matrix";
  static constexpr std::string_view summary =
      "one point, Total Lagrangian, the stiffness that the mean-dilatation element adds when undeformed";
};

}  // namespace sandglass
