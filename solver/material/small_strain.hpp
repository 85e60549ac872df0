#pragma once

#include "math/matrix.hpp"

namespace sandglass {

/// Whether a law is isotropic.
template <class Law>
constexpr bool is_isotropic = Law::traits.isotropic;

/// The stress (Pa) of a law for a small strain e, the symmetric part of the displacement gradient:
/// K tr(e) I + 2 mu dev(e), or the small-strain stress of an anisotropic law.
template <class Law, class T>
Tensor<T> small_strain_stress(const Law& law, const Tensor<T>& strain) {
  if constexpr (is_isotropic<Law>) {
    Tensor<T> stress = T(2.0 * law.shear_modulus()) * deviator(strain);
    const T mean = T(law.bulk_modulus()) * trace(strain);
    for (int i = 0; i < 3; ++i) stress(i, i) = stress(i, i) + mean;
    return stress;
  } else {
    return law.small_strain_stress(strain);
  }
}

}  // namespace sandglass
