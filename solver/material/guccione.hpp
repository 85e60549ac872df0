#pragma once

#include <algorithm>
#include <string_view>
#include <tuple>

#include "base/parameter.hpp"
#include "material/fibre_reinforced.hpp"

namespace sandglass {

/// The law of passive heart muscle of Guccione, McCulloch and Waldman (J. Biomech. Eng. 113, 1991, 42-55),
/// transversely isotropic about its fibres, as in Land et al. (Proc. R. Soc. A 471, 2015, 20150641), here of
/// the isochoric Green strain E in material axes:
///   W = C/2 (exp(Q) - 1) + K/2 (J - 1)^2,
///   Q = bf E11^2 + bt (E22^2 + E33^2 + 2 E23^2) + 2 bfs (E12^2 + E13^2).
template <class Value>
struct GuccioneOf : FibreReinforced<GuccioneOf<Value>> {
  static constexpr std::string_view name = "guccione";
  static constexpr std::string_view summary =
      "exponential of a quadratic form of the isochoric Green strain, stiffer along fibres: heart muscle";

  Value stiffness = 0.0;
  Value along = 0.0;
  Value across = 0.0;
  Value shear = 0.0;
  Value bulk = 0.0;

  static constexpr auto parameters() {
    using Self = GuccioneOf;
    return std::tuple{
        Parameter{&Self::stiffness, "stiffness", "Pa", Range::positive(),
                  "C, twice the factor of the energy"},
        Parameter{&Self::along, "b_fibre", "-", Range::positive(), "bf, exponent of strain along the fibres"},
        Parameter{&Self::across, "b_transverse", "-", Range::positive(),
                  "bt, exponent of strain across them"},
        Parameter{&Self::shear, "b_shear", "-", Range::positive(), "bfs, exponent of shear along the fibres"},
        Parameter{&Self::bulk, "bulk_modulus", "Pa", Range::positive(), "initial bulk modulus"}};
  }

  /// The initial shear modulus (Pa), as a mean over all changes of shape: their stiffnesses are C times bt
  /// (twice), bfs (twice) and (2 bf + bt)/3.
  constexpr Value shear_modulus() const {
    return 0.1 * stiffness * (2.0 * across + 2.0 * shear + (2.0 * along + across) / 3.0);
  }
  constexpr Value bulk_modulus() const { return bulk; }

  /// Zero: there is no matrix besides the fibres.
  template <class T>
  T matrix_modulus(const Tensor<T>& /*H*/, const VolumeChange<T>& /*change*/) const {
    return T(0);
  }

  /// C exp(Q) (B o E), B o E = dQ/dE / 2, Pa.
  template <class T>
  Tensor<T> fibre_stress(const Tensor<T>& E) const {
    const Tensor<T> BE = weighted(E);
    return (T(stiffness) * (T(1) + expm1(double_dot(BE, E)))) * BE;
  }
  template <class T>
  Tensor<T> linear_fibre_stress(const Tensor<T>& E) const {
    return T(stiffness) * weighted(E);
  }

  /// C/2 (exp(Q) - 1), in J/m^3.
  template <class T>
  T isochoric_energy(const Tensor<T>& H) const {
    const Tensor<T> E = isochoric_green_strain(H, volume_change(H));
    return T(0.5 * stiffness) * expm1(double_dot(weighted(E), E));
  }

  /// Bound of the isochoric tangent; see TangentBound. d^2 W = C exp(Q) [dE:B:dE + 2 (BE : dE)^2] + S : d^2
  /// E. With F' = J^(-1/3) F, dE = F'^T dev(sym L) F', f = F' e1, c = |f|^2 and l the largest eigenvalue of
  /// F' F'^T,
  ///   dE:B:dE = bt |dE|^2 + (bf + bt - 2 bfs) dE11^2 + 2 (bfs - bt) |dE e1|^2,
  /// |dE| <= l |dev L|, |dE11| <= sqrt(2/3) c |dev L|, |dE e1|^2 <= 2/3 l c |dev L|^2; terms with negative
  /// factors are left out.
  template <class T>
  TangentBound<T> isochoric_tangent_bound(const Tensor<T>& H) const {
    const VolumeChange<T> change = volume_change(H);
    const Tensor<T> E = isochoric_green_strain(H, change);
    const Tensor<T> BE = weighted(E);
    const T r2 = change.inverse_root * change.inverse_root;
    const Tensor<T> M = r2 * to_space(BE, H);
    const T c = T(1) + T(2) * E(0, 0);
    const T l = T(1) + T(2) * largest_eigenvalue_bound(E);
    const T factor = T(stiffness) * (T(1) + expm1(double_dot(BE, E)));
    const Tensor<T> dev_M = deviator(M);
    const T curvature =
        T(across) * l * l + T(2.0 / 3.0 * max(along + across - 2.0 * shear, Value(0.0))) * c * c +
        T(4.0 / 3.0 * max(shear - across, Value(0.0))) * l * c + T(2) * double_dot(dev_M, dev_M);
    return change_of_shape_bound(factor * curvature) +
           isochoric_stress_bound(factor * T(1.0 / 3.0) * trace(M), factor * dev_M);
  }

 private:
  /// B o E: each component of E times its exponent.
  template <class T>
  Tensor<T> weighted(const Tensor<T>& E) const {
    const auto bf = T(along), bt = T(across), bfs = T(shear);
    return {{bf * E(0, 0), bfs * E(0, 1), bfs * E(0, 2),  //
             bfs * E(1, 0), bt * E(1, 1), bt * E(1, 2),   //
             bfs * E(2, 0), bt * E(2, 1), bt * E(2, 2)}};
  }
};

using Guccione = GuccioneOf<double>;

}  // namespace sandglass
