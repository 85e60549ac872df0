#pragma once

#include <algorithm>

#include "material/small_strain.hpp"
#include "mesh/hexahedron.hpp"
#include "support/dense_matrix.hpp"
#include "support/typed_lists.hpp"

namespace sandglass::verification {

/// The smallest stretch at which a law's stiffness can be compared with a bound: `smallest`, or a twentieth
/// above the stretch at which the law declares that it loses stiffness, below which there is nothing to
/// compare.
template <class Law>
constexpr double smallest_stiff_stretch(double smallest) {
  return std::max(smallest, 1.05 * Law::traits.softening_stretch);
}

/// Whether a law has fibres that resist only stretch: its stress has a kink where they slacken.
template <class Law>
inline constexpr bool slackens = Law::traits.slackens;

/// A small displacement gradient without slack: drawn from `sample` until fibres and sheets are stretched, if
/// the law has any.
template <class Law, class Sample>
Tensor<double> taut(const Sample& sample) {
  Tensor<double> H = sample();
  if constexpr (slackens<Law>) {
    while (!(deviator(H)(0, 0) > 0.0 && deviator(H)(1, 1) > 0.0)) H = sample();
  }
  return H;
}

/// Whether a law loses stiffness at some Gauss point of an element with coordinates X (m) displaced by u (m).
template <class Law>
bool loses_stiffness(const NodalVectors<double>& X, const NodalVectors<double>& u) {
  const double limit = smallest_stiff_stretch<Law>(0.0);
  for (const auto& xi : gauss_points()) {
    const Tensor<double> F = identity<double>() + transpose(u) * point_gradient(X, xi).gradient;
    if (eigenvalues(transpose(F) * F).front() < limit * limit) return true;
  }
  return false;
}

}  // namespace sandglass::verification
