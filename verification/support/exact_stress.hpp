#pragma once

#include <variant>

#include "material/laws.hpp"
#include "material/small_strain.hpp"

/// The exact stress for a uniform displacement gradient: the law itself, or its small-strain limit for linear
/// methods.
namespace sandglass::verification {

/// (H + H^T) / 2.
template <class T>
Tensor<T> symmetric_part(const Tensor<T>& H) {
  return T(0.5) * (H + transpose(H));
}

/// First Piola-Kirchhoff stress (Pa); `linear`: of small-strain theory.
template <class Law, class T>
Tensor<T> exact_stress(bool linear, const Law& law, const Tensor<T>& H) {
  return linear ? small_strain_stress(law, symmetric_part(H)) : law.piola(H);
}

/// The same of a law chosen at run time.
template <class T>
Tensor<T> exact_stress(bool linear, const AnyLaw& any_law, const Tensor<T>& H) {
  return std::visit([&](const auto& law) { return exact_stress(linear, law, H); }, any_law);
}

/// Energy density (J/m^3).
template <class Law, class T>
T exact_energy(bool linear, const Law& law, const Tensor<T>& H) {
  return linear ? T(0.5) * double_dot(exact_stress(true, law, H), H) : law.energy(H);
}

template <class T>
T exact_energy(bool linear, const AnyLaw& any_law, const Tensor<T>& H) {
  return std::visit([&](const auto& law) { return exact_energy(linear, law, H); }, any_law);
}

}  // namespace sandglass::verification
