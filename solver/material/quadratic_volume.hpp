#pragma once

#include "material/sum_of_parts.hpp"

namespace sandglass {

/// The base of all laws of the list: the volumetric energy K/2 (J - 1)^2, which a material may replace
/// (volumetric_parts.hpp). A law defines bulk_modulus() and the functions that SumOfParts needs, except those
/// below.
template <class Law>
struct QuadraticVolume : SumOfParts<Law> {
  /// K/2 (J - 1)^2 of J - 1, in J/m^3.
  template <class T>
  T volumetric_energy(const T& J_minus_one) const {
    return T(0.5 * law().bulk_modulus()) * J_minus_one * J_minus_one;
  }

  /// d(volumetric energy)/dJ in Pa, the mean Cauchy stress (tension positive) of a law that splits.
  template <class T>
  T pressure(const T& J_minus_one) const {
    return T(law().bulk_modulus()) * J_minus_one;
  }

  /// d^2(volumetric energy)/dJ^2, Pa.
  template <class T>
  T bulk_tangent(const T& /*J_minus_one*/) const {
    return T(law().bulk_modulus());
  }

 private:
  constexpr const Law& law() const { return static_cast<const Law&>(*this); }
};

/// The base of a law that wraps an elastic one, which elastic() returns, with the same initial moduli and
/// volumetric part.
template <class Law>
struct VolumeOfElastic : SumOfParts<Law> {
  static constexpr LawTraits traits{};  // of its use in kernels, where axes are those of space

  double shear_modulus() const { return law().elastic().shear_modulus(); }
  double bulk_modulus() const { return law().elastic().bulk_modulus(); }

  template <class T>
  T volumetric_energy(const T& J_minus_one) const {
    return law().elastic().volumetric_energy(J_minus_one);
  }
  template <class T>
  T pressure(const T& J_minus_one) const {
    return law().elastic().pressure(J_minus_one);
  }
  template <class T>
  T bulk_tangent(const T& J_minus_one) const {
    return law().elastic().bulk_tangent(J_minus_one);
  }

 private:
  constexpr const Law& law() const { return static_cast<const Law&>(*this); }
};

}  // namespace sandglass
