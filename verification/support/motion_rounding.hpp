#pragma once

#include <cmath>
#include <limits>

#include "problem/scene.hpp"

namespace sandglass::verification {

/// The difference of two motions of a body, over its largest displacement: every step rounds displacements,
/// at random, so that the error is that of one step times the root of their number. A rounding of the volume
/// change is one of the pressure, K / mu times as large beside the shear stress; four is for the roundings of
/// a step (float_budget_test.cpp), two for the two motions that are compared.
inline double rounding_of_motions(const Scene& scene, Precision precision, double steps) {
  const double roundoff = 0.5 * (precision == Precision::double_precision
                                     ? std::numeric_limits<double>::epsilon()
                                     : static_cast<double>(std::numeric_limits<float>::epsilon()));
  const double ratio = lame_lambdas(scene.materials).front() / shear_moduli(scene.materials).front() + 1.0;
  return 2.0 * 4.0 * roundoff * ratio * std::sqrt(steps);
}

}  // namespace sandglass::verification
