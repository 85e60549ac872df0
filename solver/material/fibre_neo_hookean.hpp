#pragma once

#include <string_view>
#include <tuple>

#include "base/parameter.hpp"
#include "material/fibre_reinforced.hpp"

namespace sandglass {

/// A neo-Hookean solid with one family of fibres: the standard reinforcing model (Qiu and Pence, J.
/// Elasticity 49, 1997, 1-30: mu gamma/2 (I4 - 1)^2 with mu gamma = k/4), with the isochoric invariant that
/// Weiss, Maker and Govindjee (CMAME 135, 1996, 107-128) use for nearly incompressible tissue,
///   W = mu/2 (I1bar - 3) + k/2 Ef^2 + K/2 (J - 1)^2,  Ef = (I4bar - 1)/2,  I4bar = J^(-2/3) a.C a.
/// Ef is the Green strain, without the change of volume, of a fibre along a. The energy is smooth: fibres
/// resist shortening as well as stretching, but soften below a stretch of 1/sqrt(3), where the solid kinks if
/// k >> mu.
template <class Value>
struct FibreNeoHookeanOf : FibreReinforced<FibreNeoHookeanOf<Value>> {
  static constexpr std::string_view name = "fibre-neo-hookean";
  static constexpr std::string_view summary =
      "neo-Hookean with one family of fibres, quadratic in their isochoric Green strain";

  Value young_modulus = 0.0;
  Value poisson_ratio = 0.0;
  Value fibre_modulus = 0.0;

  static constexpr auto parameters() {
    return std::tuple{
        Parameter{&FibreNeoHookeanOf::young_modulus, "young_modulus", "Pa", Range::positive(),
                  "initial Young's modulus of the solid without fibres"},
        Parameter{&FibreNeoHookeanOf::poisson_ratio, "poisson_ratio", "-", Range::between(-1.0, 0.5),
                  "initial Poisson's ratio of the solid without fibres"},
        Parameter{&FibreNeoHookeanOf::fibre_modulus, "fibre_modulus", "Pa", Range::at_least(0.0),
                  "increase of Young's modulus along the fibres, for an incompressible solid"}};
  }

  /// The initial moduli of the solid without fibres, Pa.
  constexpr Value shear_modulus() const { return young_modulus / 2.0 / (1.0 + poisson_ratio); }
  constexpr Value bulk_modulus() const { return young_modulus / 3.0 / (1.0 - 2.0 * poisson_ratio); }

  template <class T>
  T matrix_modulus(const Tensor<T>& /*H*/, const VolumeChange<T>& /*change*/) const {
    return T(shear_modulus());
  }

  /// k Ef a a^T, Pa.
  template <class T>
  Tensor<T> fibre_stress(const Tensor<T>& E) const {
    Tensor<T> S{};
    S(0, 0) = T(fibre_modulus) * E(0, 0);
    return S;
  }
  template <class T>
  Tensor<T> linear_fibre_stress(const Tensor<T>& E) const {
    return fibre_stress(E);
  }

  /// mu/2 (I1bar - 3) + k/2 Ef^2, in J/m^3.
  template <class T>
  T isochoric_energy(const Tensor<T>& H) const {
    const T Ef = isochoric_green_strain(H, volume_change(H))(0, 0);
    return T(1.5 * shear_modulus()) * third_of_first_invariant_growth(H) + T(0.5 * fibre_modulus) * Ef * Ef;
  }

  /// Bound of the isochoric tangent; see TangentBound. Fibres add k (dEf)^2 + k Ef d^2 Ef, where dEf =
  /// I4bar n.dev L n is at most sqrt(2/3) I4bar |dev L|.
  template <class T>
  TangentBound<T> isochoric_tangent_bound(const Tensor<T>& H) const {
    const T Ef = isochoric_green_strain(H, volume_change(H))(0, 0);
    const T c = T(1) + T(2) * Ef;
    const T square = T(2.0 / 3.0 * fibre_modulus) * c * c;
    return first_invariant_tangent_bound(T(shear_modulus()), H) + change_of_shape_bound(square) +
           fibre_stress_bound(T(fibre_modulus) * c * Ef, square);
  }
};

using FibreNeoHookean = FibreNeoHookeanOf<double>;

}  // namespace sandglass
