#pragma once

#include "element/methods.hpp"
#include "material/small_strain.hpp"

/// The exact stress for a uniform displacement gradient: the law itself, or its small-strain limit for linear
/// methods.
namespace sandglass::verification {

/// (H + H^T) / 2.
template <class T>
Tensor<T> symmetric_part(const Tensor<T>& H) {
  return T(0.5) * (H + transpose(H));
}

/// First Piola-Kirchhoff stress (Pa).
template <class Method, class Law, class T>
Tensor<T> exact_stress(const Law& law, const Tensor<T>& H) {
  if constexpr (is_linear<Method>) {
    return small_strain_stress(law, symmetric_part(H));
  } else {
    return law.piola(H);
  }
}

/// Energy density (J/m^3).
template <class Method, class Law, class T>
T exact_energy(const Law& law, const Tensor<T>& H) {
  if constexpr (is_linear<Method>) {
    return T(0.5) * double_dot(exact_stress<Method>(law, H), H);
  } else {
    return law.energy(H);
  }
}

}  // namespace sandglass::verification
