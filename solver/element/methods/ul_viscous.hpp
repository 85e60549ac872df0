#pragma once

#include <string_view>

#include "element/hourglass_viscous.hpp"
#include "element/method.hpp"
#include "element/methods/tl_none.hpp"
#include "element/updated_one_point.hpp"

namespace sandglass {

struct UlViscous : MethodWith<UpdatedOnePoint, ViscousHourglassControl, AtSmallStrainLike<TlNone>> {
  static constexpr std::string_view name = "ul-viscous";
  static constexpr std::string_view summary =
      "one point, Updated Lagrangian, viscous control: LS-DYNA's and OpenRadioss's default; no effect in "
      "equilibrium";
};

}  // namespace sandglass
