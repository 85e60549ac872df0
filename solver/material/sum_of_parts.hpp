#pragma once

#include "math/strain.hpp"

namespace sandglass {

/// What a law states about itself, as `traits`; a misspelt statement does not compile.
struct LawTraits {
  bool isotropic = true;           ///< else the law defines small_strain_stress(strain)
  bool splits_volume = true;       ///< its energy is a function of J^(-1/3) F plus a function of J; else its
                                   ///< isochoric energy is its energy without K/2 (J - 1)^2
  bool slackens = false;           ///< parts resist stretch alone: its stress has a kink where they slacken
  bool remembers = false;          ///< it has a memory; see memory.hpp
  double softening_stretch = 0.0;  ///< below it the law is unstable: compression reduces its stress
};

/// The common base of all laws: an energy that is the sum of an isochoric and a volumetric part. A law
/// derives from SumOfParts of itself and defines isochoric_energy(H), weighted_piola(V, H, change, p),
/// volumetric_energy(J - 1) and pressure(J - 1); it inherits the functions below. The base has no data: the
/// law remains an aggregate of its parameters.
template <class Law>
struct SumOfParts {
  /// The isochoric part of the first Piola-Kirchhoff stress, Pa.
  template <class T>
  Tensor<T> isochoric_piola(const Tensor<T>& H) const {
    return self().weighted_piola(T(1), H, volume_change(H), T(0));
  }

  /// The strain energy density, J/m^3.
  template <class T>
  T energy(const Tensor<T>& H) const {
    return self().isochoric_energy(H) + self().volumetric_energy(jacobian_minus_one(H));
  }

  /// The first Piola-Kirchhoff stress dW/dF, Pa.
  template <class T>
  Tensor<T> piola(const Tensor<T>& H) const {
    const VolumeChange<T> change = volume_change(H);
    return self().weighted_piola(T(1), H, change, self().pressure(change.J_minus_one));
  }

 private:
  constexpr const Law& self() const { return static_cast<const Law&>(*this); }
};

}  // namespace sandglass
