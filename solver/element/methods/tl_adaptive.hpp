#pragma once

#include <string_view>

#include "base/type_list.hpp"
#include "element/hourglass_sampling.hpp"
#include "element/methods/tl_four_point.hpp"
#include "element/methods/tl_mean_dilatation.hpp"
#include "element/methods/tl_modal_sampling.hpp"
#include "element/one_point.hpp"

namespace sandglass {

/// An adaptive method declares its `Levels`, from the cheapest method to the one that it approximates. The
/// other declarations describe its undeformed elements, which are at the lowest level.
struct TlAdaptive {
  static constexpr std::string_view name = "tl-adaptive";
  static constexpr std::string_view summary =
      "one, four or eight points, each element as many as the requested accuracy needs";
  using Kinematics = OnePoint;
  using Hourglass = ModalSamplingControl;
  using Levels = TypeList<TlModalSampling, TlFourPoint, TlMeanDilatation>;
};

}  // namespace sandglass
