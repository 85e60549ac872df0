#pragma once

#include <string_view>

#include "element/hourglass_perturbation.hpp"
#include "element/method.hpp"
#include "element/one_point_forms.hpp"

namespace sandglass {

struct TlPerturbation : MethodWith<OnePoint, PerturbationHourglassControl,
                                   OnParallelepipedsBy<ParallelepipedOnePoint>, Batches> {
  static constexpr std::string_view name = "tl-perturbation";
  static constexpr std::string_view summary =
      "one point, Total Lagrangian, perturbation hourglass control (the paper)";
};

}  // namespace sandglass
