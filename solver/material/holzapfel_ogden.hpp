#pragma once

#include <array>
#include <string_view>
#include <tuple>

#include "base/parameter.hpp"
#include "material/fibre_reinforced.hpp"
#include "math/spectral.hpp"

namespace sandglass {

/// The law of passive heart muscle of Holzapfel and Ogden (Phil. Trans. R. Soc. A 367, 2009, 3445-3475), with
/// isochoric invariants,
///   W = a/(2 b) (exp(b (I1bar - 3)) - 1) + sum_i a_i/(2 b_i) (exp(b_i <I4bar_i - 1>^2) - 1)
///     + a_fs/(2 b_fs) (exp(b_fs I8bar^2) - 1) + K/2 (J - 1)^2,
/// i = f, s: fibres and sheets resist only stretch, <x> = max(x, 0); I8bar is their shear. In the isochoric
/// Green strain, I4bar_f - 1 = 2 E11, I4bar_s - 1 = 2 E22 and I8bar = 2 E12.
template <class Value>
struct HolzapfelOgdenOf : FibreReinforced<HolzapfelOgdenOf<Value>> {
  static constexpr std::string_view name = "holzapfel-ogden";
  static constexpr std::string_view summary =
      "exponential matrix with fibres and sheets that resist only stretch: heart muscle";
  static constexpr LawTraits traits{.isotropic = false, .slackens = true};

  Value a = 0.0;
  Value b = 0.0;
  Value a_f = 0.0;
  Value b_f = 0.0;
  Value a_s = 0.0;
  Value b_s = 0.0;
  Value a_fs = 0.0;
  Value b_fs = 0.0;
  Value bulk = 0.0;

  static constexpr auto parameters() {
    using Self = HolzapfelOgdenOf;
    constexpr Range any_stiffness = Range::at_least(0.0), exponent = Range::positive();
    return std::tuple{
        Parameter{&Self::a, "a", "Pa", Range::positive(), "initial shear modulus of the matrix"},
        Parameter{&Self::b, "b", "-", exponent, "exponent of the matrix"},
        Parameter{&Self::a_f, "a_f", "Pa", any_stiffness, "stiffness of the fibres"},
        Parameter{&Self::b_f, "b_f", "-", exponent, "exponent of the fibres"},
        Parameter{&Self::a_s, "a_s", "Pa", any_stiffness, "stiffness of the sheets"},
        Parameter{&Self::b_s, "b_s", "-", exponent, "exponent of the sheets"},
        Parameter{&Self::a_fs, "a_fs", "Pa", any_stiffness, "stiffness of shear between fibres and sheets"},
        Parameter{&Self::b_fs, "b_fs", "-", exponent, "exponent of that shear"},
        Parameter{&Self::bulk, "bulk_modulus", "Pa", Range::positive(), "initial bulk modulus"}};
  }

  /// The initial shear modulus (Pa), as a mean over all changes of shape: half of them stretch the fibres,
  /// half the sheets.
  constexpr Value shear_modulus() const { return a + 0.1 * (4.0 / 3.0 * (a_f + a_s) + 2.0 * a_fs); }
  constexpr Value bulk_modulus() const { return bulk; }

  template <class T>
  T matrix_modulus(const Tensor<T>& H, const VolumeChange<T>& /*change*/) const {
    return T(a) * (T(1) + expm1(T(3.0 * b) * third_of_first_invariant_growth(H)));
  }

  template <class T>
  Tensor<T> fibre_stress(const Tensor<T>& E) const {
    return stress_of(stretched(a_f, b_f, E(0, 0)).slope, stretched(a_s, b_s, E(1, 1)).slope,
                     sheared(E(0, 1)).slope);
  }
  template <class T>
  Tensor<T> linear_fibre_stress(const Tensor<T>& E) const {
    return stress_of(T(4.0 * a_f) * E(0, 0), T(4.0 * a_s) * E(1, 1), T(4.0 * a_fs) * E(0, 1));
  }

  /// The isochoric part of W, in J/m^3.
  template <class T>
  T isochoric_energy(const Tensor<T>& H) const {
    const Tensor<T> E = isochoric_green_strain(H, volume_change(H));
    return T(0.5 * a / b) * expm1(T(3.0 * b) * third_of_first_invariant_growth(H)) +
           (stretched(a_f, b_f, E(0, 0)).energy + stretched(a_s, b_s, E(1, 1)).energy +
            sheared(E(0, 1)).energy);
  }

  /// Bound of the isochoric tangent; see TangentBound. The squares of dE11, dE22 and dE12 have one bound: the
  /// largest eigenvalue of sum_i k_i N_i N_i^T, N_i = dE_i/d(dev L), is that of the matrix of
  /// sqrt(k_i k_j) N_i : N_j.
  template <class T>
  TangentBound<T> isochoric_tangent_bound(const Tensor<T>& H) const {
    const VolumeChange<T> change = volume_change(H);
    const Tensor<T> E = isochoric_green_strain(H, change);
    const Exponential<T> f = stretched(a_f, b_f, E(0, 0)), s = stretched(a_s, b_s, E(1, 1)),
                         fs = sheared(E(0, 1));
    const T r = change.inverse_root;
    Tensor<T> Fbar = r * H;
    for (int i = 0; i < 3; ++i) Fbar(i, i) = Fbar(i, i) + r;
    const auto in_space = [&](int i, int j) {  // dev sym(f_i f_j^T), f_i = F' e_i
      Tensor<T> N;
      for (int m = 0; m < 3; ++m) {
        for (int n = 0; n < 3; ++n) {
          N(m, n) = T(0.5) * (Fbar(m, i) * Fbar(n, j) + Fbar(n, i) * Fbar(m, j));
        }
      }
      return deviator(N);
    };
    const std::array<Tensor<T>, 3> N{sqrt(f.curvature) * in_space(0, 0), sqrt(s.curvature) * in_space(1, 1),
                                     sqrt(fs.curvature) * in_space(0, 1)};
    Tensor<T> products;
    for (int i = 0; i < 3; ++i) {
      for (int j = 0; j < 3; ++j) {
        products(i, j) = double_dot(N[static_cast<std::size_t>(i)], N[static_cast<std::size_t>(j)]);
      }
    }
    const T none(0);
    const T shear_mean = T(2.0 / 3.0) * fs.slope * E(0, 1);  // tr(F' S F'^T)/3, F'e1 . F'e2 = 2 E12
    const auto [first, second, third] = spectrum(products).values;
    return matrix_bound(H) + change_of_shape_bound(max(first, max(second, third))) +
           fibre_stress_bound(f.slope * (T(1) + T(2) * E(0, 0)), none) +
           fibre_stress_bound(s.slope * (T(1) + T(2) * E(1, 1)), none) +
           isochoric_stress_bound(shear_mean, fs.slope * in_space(0, 1));
  }

 private:
  /// A function psi(E) of a strain with its derivatives.
  template <class T>
  struct Exponential {
    T energy;
    T slope;
    T curvature;
  };

  /// a/(2 b) (exp(b x^2) - 1) of x = 2 E, Pa.
  template <class T>
  static Exponential<T> exponential(const Value& a, const Value& b, const T& E) {
    const T exponent = T(4.0 * b) * E * E;
    const T growth = expm1(exponent), stiffness = T(4.0 * a) * (T(1) + growth);
    return {T(0.5 * a / b) * growth, stiffness * E, stiffness * (T(1) + T(2) * exponent)};
  }

  /// The same for stretched fibres; shortened ones have no energy.
  template <class T>
  static Exponential<T> stretched(const Value& a, const Value& b, const T& E) {
    Exponential<T> psi = exponential(a, b, max(E, T(0)));
    psi.curvature = select(E < T(0), T(0), psi.curvature);
    return psi;
  }

  template <class T>
  Exponential<T> sheared(const T& E) const {
    return exponential(a_fs, b_fs, E);
  }

  /// dpsi/dE of the derivatives by E11, by E22 and by E12 = E21.
  template <class T>
  static Tensor<T> stress_of(const T& by_11, const T& by_22, const T& by_12) {
    Tensor<T> S{};
    S(0, 0) = by_11;
    S(1, 1) = by_22;
    S(0, 1) = T(0.5) * by_12;
    S(1, 0) = S(0, 1);
    return S;
  }

  /// w'' = b w' = b mu/2.
  template <class T>
  TangentBound<T> matrix_bound(const Tensor<T>& H) const {
    const T mu = matrix_modulus(H, volume_change(H));
    return first_invariant_tangent_bound(mu, T(0.5 * b) * mu, H);
  }
};

using HolzapfelOgden = HolzapfelOgdenOf<double>;

}  // namespace sandglass
