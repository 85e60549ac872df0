#pragma once

#include <string_view>

#include "element/hourglass_sampling.hpp"
#include "element/method.hpp"
#include "element/methods/tl_four_point.hpp"
#include "element/methods/tl_mean_dilatation.hpp"
#include "element/methods/tl_modal_sampling.hpp"
#include "element/one_point.hpp"

namespace sandglass {

struct TlAdaptive : MethodWith<OnePoint, ModalSamplingControl,
                               AdaptsAmong<TlModalSampling, TlFourPoint, TlMeanDilatation>> {
  static constexpr std::string_view name = "tl-adaptive";
  static constexpr std::string_view summary =
      "one, four or eight points per element, as the requested accuracy needs";
};

}  // namespace sandglass
