#pragma once

#include "math/matrix.hpp"

namespace sandglass {

/// The Cauchy stress (Pa) of a small strain e = sym(grad u) by the law's tangent at rest: lambda tr(e) I + 2
/// mu e (Hooke), or what the law itself says where it is not isotropic at rest. Linear in e.
template <class Law, class T>
Tensor<T> small_strain_stress(const Law& law, const Tensor<T>& e) {
  if constexpr (requires { law.small_strain_stress(e); }) {
    return law.small_strain_stress(e);
  } else {
    const T two_mu(2.0 * law.shear_modulus());
    const T mean = T(law.bulk_modulus() - 2.0 / 3.0 * law.shear_modulus()) * trace(e);
    Tensor<T> stress;
    for (int i = 0; i < 3; ++i) {
      for (int j = i; j < 3; ++j) {
        stress(i, j) = two_mu * e(i, j);
        stress(j, i) = stress(i, j);
      }
      stress(i, i) = stress(i, i) + mean;
    }
    return stress;
  }
}

}  // namespace sandglass
