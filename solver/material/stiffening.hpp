#pragma once

#include <algorithm>

#include "material/called_law.hpp"

namespace sandglass {

/// The stiffness of a law against most changes of shape at the displacement gradient H, over the undeformed
/// one; at least 1. It is a third of the mean over all changes of shape, because the stiffest one dominates
/// the mean of stiffening laws; so it is 1 at usual strains. The mean is taken of the second derivatives of
/// the isochoric energy along the paths F + t D F, D symmetric and without trace, over twice the initial
/// shear modulus, computed from differences of the stress; the five D below are orthonormal. Softening is not
/// counted: if the stiffness is overestimated, steps are short; if it is underestimated, they overshoot.
inline double stiffening(const CalledLaw& law, const Tensor<double>& H, const MaterialAxes<double>* axes) {
  constexpr double a = 0.70710678118654752, b = 0.40824829046386302;  // 1/sqrt(2), 1/sqrt(6)
  constexpr std::array<Tensor<double>, 5> changes_of_shape{{{{a, 0, 0, 0, -a, 0, 0, 0, 0}},
                                                            {{b, 0, 0, 0, b, 0, 0, 0, -2 * b}},
                                                            {{0, a, 0, a, 0, 0, 0, 0, 0}},
                                                            {{0, 0, a, 0, 0, 0, a, 0, 0}},
                                                            {{0, 0, 0, 0, 0, a, 0, a, 0}}}};
  constexpr double step = 1e-6, share = 1.0 / 3.0;
  const auto stress = [&](const Tensor<double>& at) {
    return law.weighted_piola(1.0, at, volume_change(at), 0.0, axes);
  };
  const Tensor<double> F = identity<double>() + H, P = stress(H);
  double sum = 0.0;
  for (const Tensor<double>& D : changes_of_shape) {
    const Tensor<double> DF = D * F;
    sum += double_dot(stress(H + step * DF) - P, DF) / step;
  }
  return std::max(1.0, share * 0.1 * sum / law.shear_modulus());
}

}  // namespace sandglass
