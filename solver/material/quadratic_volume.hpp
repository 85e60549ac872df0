#pragma once

#include "math/strain.hpp"

namespace sandglass {

/// The common base of all laws of the list: the volumetric energy K/2 (J - 1)^2, and a total that is the sum
/// of an isochoric and a volumetric part. A law derives from QuadraticVolume of itself and defines
/// bulk_modulus(), isochoric_energy(H) and weighted_piola(V, H, change, p); it inherits the functions below.
/// The base has no data: the law remains an aggregate of its parameters.
template <class Law>
struct QuadraticVolume {
  /// Whether the energy is a function of J^(-1/3) F plus a function of J. A law without this property sets it
  /// to false; its isochoric energy is then its energy without K/2 (J - 1)^2.
  static constexpr bool splits_volume = true;

  /// K/2 (J - 1)^2 of J - 1, in J/m^3.
  template <class T>
  T volumetric_energy(const T& J_minus_one) const {
    return T(0.5 * self().bulk_modulus()) * J_minus_one * J_minus_one;
  }

  /// d(volumetric energy)/dJ in Pa, the mean Cauchy stress (tension positive) of a law that splits.
  template <class T>
  T pressure(const T& J_minus_one) const {
    return T(self().bulk_modulus()) * J_minus_one;
  }

  /// d^2(volumetric energy)/dJ^2, Pa.
  template <class T>
  T bulk_tangent(const T& /*J_minus_one*/) const {
    return T(self().bulk_modulus());
  }

  /// The isochoric part of the first Piola-Kirchhoff stress, Pa.
  template <class T>
  Tensor<T> isochoric_piola(const Tensor<T>& H) const {
    return self().weighted_piola(T(1), H, volume_change(H), T(0));
  }

  /// The strain energy density, J/m^3.
  template <class T>
  T energy(const Tensor<T>& H) const {
    return self().isochoric_energy(H) + volumetric_energy(jacobian_minus_one(H));
  }

  /// The first Piola-Kirchhoff stress dW/dF, Pa.
  template <class T>
  Tensor<T> piola(const Tensor<T>& H) const {
    const VolumeChange<T> change = volume_change(H);
    return self().weighted_piola(T(1), H, change, pressure(change.J_minus_one));
  }

 private:
  constexpr const Law& self() const { return static_cast<const Law&>(*this); }
};

}  // namespace sandglass
