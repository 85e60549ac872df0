#pragma once

#include "material/tangent_bound.hpp"
#include "support/derivatives.hpp"

namespace sandglass::verification {

/// L : A : L of the tangent in the current configuration for a basis of the spatial gradients L, with dF = L
/// F.
template <class Law>
Matrix<double, 9, 9> current_tangent(const Law& law, const Tensor<double>& H) {
  const Tensor<double> F = identity<double>() + H;
  Matrix<double, 9, 9> A{};
  for (int n = 0; n < 9; ++n) {
    const Tensor<double> dF = unit<3, 3>(static_cast<std::size_t>(n)) * F;
    const Tensor<double> current = slope(law.piola(along(H, dF))) * transpose(F);
    for (int m = 0; m < 9; ++m) A(m, n) = current.entries[static_cast<std::size_t>(m)];
  }
  return A;
}

/// bound - A for the bound volumetric (tr L)^2 + gradient |L|^2.
inline Matrix<double, 9, 9> slack(const TangentBound<double>& bound, const Matrix<double, 9, 9>& A) {
  Matrix<double, 9, 9> difference = -1.0 * A;
  for (int n = 0; n < 9; ++n) difference(n, n) += bound.gradient;
  for (int i = 0; i < 9; i += 4) {
    for (int j = 0; j < 9; j += 4) difference(i, j) += bound.volumetric;
  }
  return difference;
}

}  // namespace sandglass::verification
