#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <string_view>
#include <tuple>

#include "base/parameter.hpp"
#include "material/first_invariant.hpp"
#include "material/quadratic_volume.hpp"

namespace sandglass {

/// A neo-Hookean solid with one family of straight fibres along a, |a| = 1: the standard reinforcing model
/// (Qiu and Pence, J. Elasticity 49, 1997, 1-30: mu gamma/2 (I4 - 1)^2 with mu gamma = k/4), with the
/// isochoric invariant that Weiss, Maker and Govindjee (CMAME 135, 1996, 107-128) use for nearly
/// incompressible tissue,
///   W = mu/2 (I1bar - 3) + k/2 Ef^2 + K/2 (J - 1)^2,  Ef = (I4bar - 1)/2,  I4bar = J^(-2/3) a.C a.
/// Ef is the Green strain of a fibre without the change of volume. The energy is smooth: fibres resist
/// shortening as they resist stretching, but soften below a stretch of 1/sqrt(3), where the solid kinks if
/// k >> mu.
struct FibreNeoHookean : QuadraticVolume<FibreNeoHookean> {
  static constexpr std::string_view name = "fibre-neo-hookean";
  static constexpr std::string_view summary =
      "neo-Hookean with one family of fibres, quadratic in their isochoric Green strain";

  double young_modulus = 0.0;
  double poisson_ratio = 0.0;
  double fibre_modulus = 0.0;
  std::array<double, 3> fibre_direction{};  ///< of any length except zero

  static constexpr auto parameters() {
    return std::tuple{
        Parameter{&FibreNeoHookean::young_modulus, "young_modulus", "Pa", Range::positive(),
                  "initial Young's modulus of the solid without fibres"},
        Parameter{&FibreNeoHookean::poisson_ratio, "poisson_ratio", "-", Range::between(-1.0, 0.5),
                  "initial Poisson's ratio of the solid without fibres"},
        Parameter{&FibreNeoHookean::fibre_modulus, "fibre_modulus", "Pa", Range::at_least(0.0),
                  "increase of Young's modulus along the fibres, for an incompressible solid"},
        Parameter{&FibreNeoHookean::fibre_direction, "fibre_direction", "-", Range::any(),
                  "direction [x, y, z] of the fibres in the undeformed body; its length does not matter"}};
  }

  std::optional<BrokenRule> broken_rule() const {
    if (square_length() > 0.0 && std::isfinite(1.0 / square_length())) return std::nullopt;
    const auto& [x, y, z] = fibre_direction;
    return BrokenRule{"fibre_direction",
                      fmt::format("= [{}, {}, {}] must have a length other than zero", x, y, z)};
  }

  /// The initial moduli of the solid without fibres, Pa.
  constexpr double shear_modulus() const { return young_modulus / 2.0 / (1.0 + poisson_ratio); }
  constexpr double bulk_modulus() const { return young_modulus / 3.0 / (1.0 - 2.0 * poisson_ratio); }

  /// The stress (Pa) of a small strain e: K tr(e) I + 2 mu dev(e) + k (a.dev(e) a) dev(a a^T).
  template <class T>
  Tensor<T> small_strain_stress(const Tensor<T>& strain) const {
    const Tensor<T> isochoric = deviator(strain);
    const Triple<T> a = direction<T>();
    const T scale(1.0 / square_length());
    const Tensor<T> along = deviator(scale * (a * transpose(a)));
    Tensor<T> stress =
        T(2.0 * shear_modulus()) * isochoric + (T(fibre_modulus) * double_dot(along, isochoric)) * along;
    const T mean = T(bulk_modulus()) * trace(strain);
    for (int i = 0; i < 3; ++i) stress(i, i) = stress(i, i) + mean;
    return stress;
  }

  /// mu/2 (I1bar - 3) + k/2 Ef^2, in J/m^3.
  template <class T>
  T isochoric_energy(const Tensor<T>& H) const {
    const T E = fibre_state(H, volume_change(H)).strain;
    return T(1.5 * shear_modulus()) * third_of_first_invariant_growth(H) + T(0.5 * fibre_modulus) * E * E;
  }

  /// V P (J), the first Piola-Kirchhoff stress times its reference volume V (m^3), for a pressure p (Pa,
  /// tension positive) that may differ from the law's. Fibres add
  ///   k Ef dEf/dF = q (F a a^T - I4 / (3 J) cof F),  q = k Ef J^(-2/3).
  template <class T>
  Tensor<T> weighted_piola(const T& V, const Tensor<T>& H, const VolumeChange<T>& change, const T& p) const {
    const FibreState<T> fibre = fibre_state(H, change);
    const T r = change.inverse_root;
    const T r2 = r * r;
    const T q = (T(fibre_modulus) * V) * (fibre.strain * r2);
    const T mean = T(1.0 / 3.0) * q * fibre.square_stretch * (r2 * r);
    Tensor<T> P = first_invariant_piola(T(shear_modulus()) * V, V * p - mean, H, change);
    const Triple<T> a = direction<T>();
    const T scaled = T(1.0 / square_length()) * q;
    for (int i = 0; i < 3; ++i) {
      const T qv = scaled * fibre.v(i, 0);
      for (int j = 0; j < 3; ++j) P(i, j) = P(i, j) + qv * a(j, 0);
    }
    return P;
  }

  /// V tau (J), the Kirchhoff stress J sigma times its reference volume; fibres add q dev(F a (F a)^T).
  template <class T>
  Tensor<T> weighted_kirchhoff(const T& V, const Tensor<T>& H, const VolumeChange<T>& change,
                               const T& p) const {
    const FibreState<T> fibre = fibre_state(H, change);
    const T q = (T(fibre_modulus / square_length()) * V) *
                (fibre.strain * (change.inverse_root * change.inverse_root));
    return first_invariant_kirchhoff(T(shear_modulus()) * V, V * p, left_cauchy_green_minus_identity(H),
                                     change) +
           q * deviator(fibre.v * transpose(fibre.v));
  }

  /// Bound of the isochoric tangent; see TangentBound. Fibres add k c [c (n.dev L n)^2 + Ef Q(L)] with c =
  /// I4bar, n = F a/|F a| and Q = |L n|^2 - 4/3 tr L n.L n + 2/9 (tr L)^2 + tr(L L)/3. The square is at most
  /// 2/3 |dev L|^2 = 2/3 (|L|^2 - (tr L)^2 / 3). Q has uncoupled parts: n.L n with the trace of L across n,
  /// eigenvalues 1/2 +- sqrt(17)/6; shears along n, 1/2 +- sqrt(13)/6; shears and the spin across n, +-1/3.
  /// The square involves only the first, so that shortened fibres (Ef < 0) take the larger of two numbers.
  template <class T>
  TangentBound<T> isochoric_tangent_bound(const Tensor<T>& H) const {
    const VolumeChange<T> change = volume_change(H);
    const FibreState<T> fibre = fibre_state(H, change);
    const T c = change.inverse_root * change.inverse_root * fibre.square_stretch;
    const T square = T(2.0 / 3.0) * c;
    const T rest =
        max(max(T(0.5 + std::sqrt(17.0) / 6.0) * fibre.strain, T(0.5 - std::sqrt(17.0) / 6.0) * fibre.strain),
            T(-1.0 / 3.0) * fibre.strain - square);
    const T kc = T(fibre_modulus) * c;
    return first_invariant_tangent_bound(T(shear_modulus()), H) +
           TangentBound<T>{.volumetric = T(-1.0 / 3.0) * kc * square, .gradient = kc * (square + rest)};
  }

 private:
  /// The deformation of the fibres at a point.
  template <class T>
  struct FibreState {
    Triple<T> v;       ///< F a times the length of `fibre_direction`
    T square_stretch;  ///< I4 = a.C a
    T strain;          ///< Ef
  };

  /// Ef with all its digits near the undeformed state: 2 Ef = J^(-2/3) (I4 - 1) + (J^(-2/3) - 1), and with
  /// r = J^(-1/3), r^2 - 1 = -(J - 1) r^3 (1 + r) / (1 + r + r^2). H is symmetrised before it is multiplied
  /// with a, so that a small rotation leaves no strain.
  template <class T>
  FibreState<T> fibre_state(const Tensor<T>& H, const VolumeChange<T>& change) const {
    const Triple<T> a = direction<T>();
    const Triple<T> Ha = H * a;
    T linear = T(0);
    for (int i = 0; i < 3; ++i) {
      linear = linear + (a(i, 0) * a(i, 0)) * H(i, i);
      for (int j = i + 1; j < 3; ++j) linear = linear + (a(i, 0) * a(j, 0)) * (H(i, j) + H(j, i));
    }
    const T growth = T(1.0 / square_length()) * (T(2) * linear + double_dot(Ha, Ha));  // I4 - 1
    const T r = change.inverse_root;
    const T r2 = r * r;
    const T shrinkage = change.J_minus_one * (r2 * r) * (T(1) + r) / (T(1) + r + r2);  // 1 - r^2
    return {a + Ha, T(1) + growth, T(0.5) * (r2 * growth - shrinkage)};
  }

  template <class T>
  Triple<T> direction() const {
    return {{T(fibre_direction[0]), T(fibre_direction[1]), T(fibre_direction[2])}};
  }

  constexpr double square_length() const {
    const auto& [x, y, z] = fibre_direction;
    return x * x + y * y + z * z;
  }
};

}  // namespace sandglass
