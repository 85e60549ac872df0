#pragma once

#include <array>
#include <string_view>
#include <tuple>

#include "base/parameter.hpp"
#include "material/quadratic_volume.hpp"
#include "material/tangent_bound.hpp"
#include "math/spectral.hpp"
#include "math/strain.hpp"

namespace sandglass {

/// Ogden's law in isochoric principal stretches lbar_a = J^(-1/3) l_a, with two terms,
///   W = sum_p 2 mu_p / alpha_p^2 (lbar_1^alpha_p + lbar_2^alpha_p + lbar_3^alpha_p - 3) + K/2 (J - 1)^2.
/// The sum of the mu_p is the initial shear modulus: the convention of ABAQUS, and of Miller and Chinzei for
/// the brain (J. Biomech. 35 (2002) 483: instantaneous mu = 842 Pa, alpha = -4.7). alpha = 2 gives the
/// neo-Hookean law, 2 and -2 together that of Mooney and Rivlin, 0 Hencky's. Energies in J/m^3, stresses in
/// Pa, per reference volume.
///
/// It is written in logarithmic stretches x_a = ln lbar_a, which sum to zero, so that nothing cancels near
/// the undeformed state. With b = F F^T = I + e, x_a is half the deviator of log1p(e_a).
template <class Value>
struct OgdenOf : QuadraticVolume<OgdenOf<Value>> {
  static constexpr std::string_view name = "ogden";
  static constexpr std::string_view summary = "two powers of the isochoric principal stretches";
  static constexpr LawTraits traits{};

  Value mu1 = 0.0;
  Value alpha1 = 2.0;
  Value mu2 = 0.0;
  Value alpha2 = 2.0;
  Value K = 0.0;

  static constexpr auto parameters() {
    return std::tuple{
        Parameter{&OgdenOf::mu1, "mu1", "Pa", Range::positive(), "shear modulus of the first term"},
        Parameter{&OgdenOf::alpha1, "alpha1", "-", Range::any(), "exponent of the first term"},
        Parameter{&OgdenOf::mu2, "mu2", "Pa", Range::at_least(0.0), "shear modulus of the second term",
                  false},
        Parameter{&OgdenOf::alpha2, "alpha2", "-", Range::any(), "exponent of the second term", false},
        Parameter{&OgdenOf::K, "bulk_modulus", "Pa", Range::positive(), "initial bulk modulus"}};
  }

  constexpr Value shear_modulus() const { return mu1 + mu2; }
  constexpr Value bulk_modulus() const { return K; }

  /// sum_p 2 mu_p / alpha_p^2 sum_a (e^(alpha x_a) - 1), in J/m^3: because the x_a sum to zero, alpha x_a may
  /// be subtracted, which leaves only positive terms.
  template <class T>
  T isochoric_energy(const Tensor<T>& H) const {
    const auto x = logarithmic_stretches(spectrum(left_cauchy_green_minus_identity(H)).values);
    T W = T(0);
    for (const T& x_a : x) {
      W = W + x_a * x_a * sum_of_terms(x_a, [](const T& y) { return relative_exponential_remainder(y); });
    }
    return W;
  }

  /// V P (J), the first Piola-Kirchhoff stress times its reference volume V (m^3), for a pressure p (Pa,
  /// tension positive) that may differ from the law's: P = (tau / J + p I) cof F with the isochoric Kirchhoff
  /// stress tau, which is of first order in the strain.
  template <class T>
  Tensor<T> weighted_piola(const T& V, const Tensor<T>& H, const VolumeChange<T>& change, const T& p) const {
    const T r = change.inverse_root;
    Tensor<T> sigma = (V * (r * r * r)) * isochoric_kirchhoff(H);
    for (int i = 0; i < 3; ++i) sigma(i, i) = sigma(i, i) + V * p;
    return sigma * deformation_cofactor(H);
  }

  /// V tau (J), the Kirchhoff stress J sigma, including p J I, times its reference volume.
  template <class T>
  Tensor<T> weighted_kirchhoff(const T& V, const Tensor<T>& H, const VolumeChange<T>& change,
                               const T& p) const {
    Tensor<T> tau = V * isochoric_kirchhoff(H);
    const T mean = V * p * (T(1) + change.J_minus_one);
    for (int i = 0; i < 3; ++i) tau(i, i) = tau(i, i) + mean;
    return tau;
  }

  /// Bound of the isochoric tangent in the current configuration; see TangentBound. In the principal frame
  /// (Ogden, Non-linear Elastic Deformations, section 6.1.4) d^2 W has uncoupled parts.
  ///
  /// Shear in the plane of two axes, with the secant g = (t_a - t_b)/(e_a - e_b) of the principal stresses t,
  /// is a form of (L_ab, L_ba) with g (1 + e_b) and g (1 + e_a) on its diagonal and c = g (1 + e_a) - t_a off
  /// it. Its larger eigenvalue bounds `gradient`.
  ///
  /// Stretch along the axes, l_a = L_aa: sum_a (k_a (dev l)_a^2 - t_a l_a^2) with k_a = sum_p 2 mu_p
  /// lbar_a^alpha_p. With l = s u + w, u = (1, 1, 1)/sqrt 3, w normal to it, that is at most
  /// top |w|^2 + 2 |t|/sqrt 3 |s| |w|, since the t_a sum to zero; top = mean(k - t) + |dev(k - t)|/sqrt 6 is
  /// the larger eigenvalue of diag(k - t) on the plane of w. The mixed term is split equally between
  /// s^2 = (tr L)^2 / 3 and |w|^2.
  template <class T>
  TangentBound<T> isochoric_tangent_bound(const Tensor<T>& H) const {
    const std::array<T, 3> e = spectrum(left_cauchy_green_minus_identity(H)).values;
    const std::array<T, 3> x = logarithmic_stretches(e);
    const std::array<T, 3> t = principal_stresses(x);
    const std::array<T, 3> g = stress_secants(e);
    T gradient = T(0);
    for (std::size_t c = 0; c < 3; ++c) {
      const std::size_t a = (c + 1) % 3, b = (c + 2) % 3;
      const T half = T(0.5) * g[c] * (T(2) + e[a] + e[b]);
      const T mixed = half - T(0.5) * (t[a] + t[b]);
      const T apart = T(0.5) * (t[a] - t[b]);
      gradient = max(gradient, half + sqrt(apart * apart + mixed * mixed));
    }
    std::array<T, 3> k_minus_t;
    for (std::size_t a = 0; a < 3; ++a) {
      k_minus_t[a] = T(2) * sum_of_terms(x[a], [](const T& y) { return T(1) + expm1(y); }) - t[a];
    }
    const T mean = T(1.0 / 3.0) * (k_minus_t[0] + k_minus_t[1] + k_minus_t[2]);
    const T top = mean + T(1.0 / std::sqrt(6.0)) * length(without_mean(k_minus_t));
    const T mixed = T(1.0 / std::sqrt(3.0)) * length(t);
    gradient = max(gradient, top + mixed);
    return {.volumetric = T(1.0 / 3.0) * (mixed - gradient), .gradient = gradient};
  }

 private:
  template <class T>
  static std::array<T, 3> without_mean(const std::array<T, 3>& a) {
    const T mean = T(1.0 / 3.0) * (a[0] + a[1] + a[2]);
    return {a[0] - mean, a[1] - mean, a[2] - mean};
  }
  template <class T>
  static T length(const std::array<T, 3>& a) {
    return sqrt(a[0] * a[0] + a[1] * a[1] + a[2] * a[2]);
  }

  /// x_a = ln lbar_a from the principal values of e. The ratios of stretches do without their mean.
  template <class T>
  static std::array<T, 3> logarithmic_stretches(const std::array<T, 3>& e) {
    const T inverse = T(1) / (T(1) + e[2]);
    const T x0 = T(0.5) * log1p(inverse * (e[0] - e[2])), x1 = T(0.5) * log1p(inverse * (e[1] - e[2]));
    return without_mean(std::array<T, 3>{x0, x1, T(0)});
  }

  /// sum_p mu_p f(alpha_p x).
  template <class T, class Function>
  T sum_of_terms(const T& x, const Function& f) const {
    return T(mu1) * f(T(alpha1) * x) + T(mu2) * f(T(alpha2) * x);
  }

  /// 2 mu/alpha (e^(alpha x_a) - 1) (Pa) of one term. The product of the exponentials is one, so that the
  /// smallest follows from the others, whose digits are all significant.
  template <class T>
  static std::array<T, 3> stresses_of_term(const Value& mu, const Value& exponent,
                                           const std::array<T, 3>& x) {
    constexpr double least = 1e-16;  // Hencky's law to the last bit
    const Value alpha = select(abs(exponent) < Value(least), Value(least), exponent);
    T a = T(alpha) * x[0], b = T(alpha) * x[1], c = T(alpha) * x[2];
    const auto swap_if = [](const auto& mask, T& left, T& right) {
      const T old = left;
      left = select(mask, right, left);
      right = select(mask, old, right);
    };
    const auto b_is_less = b < c;
    swap_if(b_is_less, b, c);
    const auto a_is_least = a < c;
    swap_if(a_is_least, a, c);
    a = expm1(a);
    b = expm1(b);
    const T product = a + b + a * b;
    c = -product / (T(1) + product);
    swap_if(a_is_least, a, c);
    swap_if(b_is_less, b, c);
    const T f = T(2.0 * mu / alpha);
    return {f * a, f * b, f * c};
  }

  /// t_a = dW/dx_a (Pa): the deviator of the terms' sum.
  template <class T>
  std::array<T, 3> principal_stresses(const std::array<T, 3>& x) const {
    const std::array<T, 3> t = stresses_of_term(mu1, alpha1, x);
    if (is_zero(mu2)) return without_mean(t);
    const std::array<T, 3> second = stresses_of_term(mu2, alpha2, x);
    return without_mean(std::array<T, 3>{t[0] + second[0], t[1] + second[1], t[2] + second[2]});
  }

  /// (t_a - t_b)/(e_a - e_b) for the pairs of axes, each stored at the third axis. With
  /// l = ln((1 + e_a)/(1 + e_b)) and e_a the larger of both, it is sum_p mu_p e^(alpha x_b) (e^(alpha l/2) -
  /// 1)/(alpha l/2) times l/(e_a - e_b).
  template <class T>
  std::array<T, 3> stress_secants(const std::array<T, 3>& e) const {
    const std::array<T, 3> x = logarithmic_stretches(e);
    std::array<T, 3> secants;
    for (std::size_t c = 0; c < 3; ++c) {
      const std::size_t a = (c + 1) % 3, b = (c + 2) % 3;
      const T low = min(e[a], e[b]);
      const T x_low = min(x[a], x[b]);
      const T z = (max(e[a], e[b]) - low) / (T(1) + low);
      const T l = log1p(z);
      const auto term = [&](const Value& mu, const Value& alpha) {
        return T(mu) * (T(1) + expm1(T(alpha) * x_low)) * relative_expm1(T(0.5 * alpha) * l);
      };
      secants[c] = (term(mu1, alpha1) + term(mu2, alpha2)) * relative_log1p(z) / (T(1) + low);
    }
    return secants;
  }

  /// The isochoric part of the Kirchhoff stress, Pa.
  template <class T>
  Tensor<T> isochoric_kirchhoff(const Tensor<T>& H) const {
    const Spectrum<T> e = spectrum(left_cauchy_green_minus_identity(H));
    return isotropic_tensor(e, principal_stresses(logarithmic_stretches(e.values)),
                            [this](const auto& values) { return this->stress_secants(values); });
  }
};

using Ogden = OgdenOf<double>;

}  // namespace sandglass
