#pragma once

#include <cmath>
#include <string_view>
#include <tuple>

#include "base/parameter.hpp"
#include "material/first_invariant.hpp"
#include "material/quadratic_volume.hpp"

namespace sandglass {

/// The law of Mooney and Rivlin with isochoric invariants of C = F^T F (Mooney, J. Applied Physics 11,
/// 1940, 582-592; Rivlin, Phil. Trans. R. Soc. A 241, 1948, 379-397; isochoric as in ABAQUS),
///   W = c10 (J^(-2/3) tr C - 3) + c01 (J^(-4/3) (tr^2 C - tr C^2) / 2 - 3) + K/2 (J - 1)^2.
template <class Value>
struct MooneyRivlinOf : QuadraticVolume<MooneyRivlinOf<Value>> {
  static constexpr std::string_view name = "mooney-rivlin";
  static constexpr std::string_view summary = "linear in both isochoric invariants";
  static constexpr LawTraits traits{};

  Value c10 = 0.0;
  Value c01 = 0.0;
  Value bulk = 0.0;

  static constexpr auto parameters() {
    return std::tuple{
        Parameter{&MooneyRivlinOf::c10, "c10", "Pa", Range::positive(), "factor of the first invariant"},
        Parameter{&MooneyRivlinOf::c01, "c01", "Pa", Range::at_least(0.0), "factor of the second invariant"},
        Parameter{&MooneyRivlinOf::bulk, "bulk_modulus", "Pa", Range::positive(), "initial bulk modulus"}};
  }

  constexpr Value shear_modulus() const { return 2.0 * (c10 + c01); }
  constexpr Value bulk_modulus() const { return bulk; }

  /// c10 (I1bar - 3) + c01 (I2bar - 3), in J/m^3. I2bar is the first invariant of the cofactor of F, whose
  /// determinant is J^2, so the same function computes both.
  template <class T>
  T isochoric_energy(const Tensor<T>& H) const {
    return T(3.0 * c10) * third_of_first_invariant_growth(H) +
           T(3.0 * c01) * third_of_first_invariant_growth(cofactor_minus_identity(H));
  }

  /// V P (J), the first Piola-Kirchhoff stress times its reference volume V (m^3), for a pressure p (Pa,
  /// tension positive) that may differ from the law's: P = (s / J + p I) cof F with s of `weighted_stress`.
  template <class T>
  Tensor<T> weighted_piola(const T& V, const Tensor<T>& H, const VolumeChange<T>& change, const T& p) const {
    const T r = change.inverse_root;
    Tensor<T> s = weighted_stress((r * r * r) * V, H, change);
    for (int i = 0; i < 3; ++i) s(i, i) = s(i, i) + V * p;
    return s + s * cofactor_minus_identity(H);
  }

  /// V tau (J), the Kirchhoff stress J sigma times its reference volume, for the same arguments.
  template <class T>
  Tensor<T> weighted_kirchhoff(const T& V, const Tensor<T>& H, const VolumeChange<T>& change,
                               const T& p) const {
    Tensor<T> tau = weighted_stress(V, H, change);
    const T mean = V * p * (T(1) + change.J_minus_one);
    for (int i = 0; i < 3; ++i) tau(i, i) = tau(i, i) + mean;
    return tau;
  }

  /// Bound of the isochoric tangent; see TangentBound. With beta = J^2 b^-1, b = F F^T and
  /// m = 2 c01 J^(-4/3) the second invariant's part is
  ///   m [tr(L^T beta L) + 2 tr(beta L L) - 4/3 tr L tr(beta L) + tr beta (2/9 (tr L)^2 - 1/3 tr(L L))];
  /// beta is split into its mean and a deviator of norm n, whose largest eigenvalue is at most sqrt(2/3) n;
  /// the mixed term involves only the deviator of L, and is split by 2 |tr L| |dev L| <= (tr L)^2/sqrt(3) +
  /// sqrt(3) |dev L|^2 = sqrt(3) |L|^2.
  template <class T>
  TangentBound<T> isochoric_tangent_bound(const Tensor<T>& H) const {
    const Tensor<T> g = left_cauchy_green_minus_identity(cofactor_minus_identity(H));  // beta - I
    const Tensor<T> d = deviator(g);
    const T deviation = sqrt(double_dot(d, d));
    const T trace_beta = T(3) + trace(g);
    const T r = volume_change(H).inverse_root;
    const T m = T(2.0 * c01) * (r * r) * (r * r);
    const TangentBound<T> second{
        .volumetric = T(-2.0 / 9.0) * m * trace_beta,
        .gradient = m * (T(2.0 / 3.0) * trace_beta + T(std::sqrt(6.0) + 2.0 / std::sqrt(3.0)) * deviation)};
    return first_invariant_tangent_bound(T(2.0 * c10), H) + second;
  }

 private:
  /// V (2 c10 J^(-2/3) dev b - 2 c01 J^(-4/3) dev(J^2 b^-1)), the Kirchhoff stress without pressure. With
  /// e = b - I the theorem of Cayley and Hamilton gives dev(J^2 b^-1) = dev(e e - (1 + tr e) e), without
  /// constants that would cancel near the undeformed state.
  template <class T>
  Tensor<T> weighted_stress(const T& V, const Tensor<T>& H, const VolumeChange<T>& change) const {
    const Tensor<T> e = left_cauchy_green_minus_identity(H);
    const T Vr2 = V * (change.inverse_root * change.inverse_root);
    const T square = T(2.0 * c01) * Vr2 * (change.inverse_root * change.inverse_root);
    const T linear = T(2.0 * c10) * Vr2 + square * (T(1) + trace(e));
    Tensor<T> s;
    for (int i = 0; i < 3; ++i) {
      for (int j = i; j < 3; ++j) {
        s(i, j) = linear * e(i, j) - square * (e(i, 0) * e(0, j) + e(i, 1) * e(1, j) + e(i, 2) * e(2, j));
        s(j, i) = s(i, j);
      }
    }
    return deviator(s);
  }
};

using MooneyRivlin = MooneyRivlinOf<double>;

}  // namespace sandglass
