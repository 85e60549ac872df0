#pragma once

#include <string_view>
#include <tuple>

#include "base/parameter.hpp"
#include "material/quadratic_volume.hpp"
#include "material/tangent_bound.hpp"
#include "math/exponential.hpp"

namespace sandglass {

/// The compressible neo-Hookean law of Bonet and Wood (Nonlinear Continuum Mechanics for Finite Element
/// Analysis, 2008, section 6.4.3), "neo-Hookean" in FEBio,
///   W = mu/2 (tr(F^T F) - 3) - mu ln J + lambda/2 (ln J)^2,  lambda = K - 2 mu/3.
///
/// It is not the sum of an isochoric and a volumetric part. Its isochoric energy here is W - K/2 (J - 1)^2,
/// whose undeformed tangent is isochoric; elements that average K/2 (J - 1)^2 therefore average the pressure
/// at small strains. At large volume changes that part is concave in J, as for StVenantKirchhoff.
template <class Value>
struct CompressibleNeoHookeanOf : QuadraticVolume<CompressibleNeoHookeanOf<Value>> {
  static constexpr std::string_view name = "compressible-neo-hookean";
  static constexpr std::string_view summary = "neo-Hookean without a split, logarithmic in the volume ratio";
  static constexpr LawTraits traits{.splits_volume = false};

  Value young_modulus = 0.0;
  Value poisson_ratio = 0.0;

  static constexpr auto parameters() {
    return std::tuple{Parameter{&CompressibleNeoHookeanOf::young_modulus, "young_modulus", "Pa",
                                Range::positive(), "initial Young's modulus"},
                      Parameter{&CompressibleNeoHookeanOf::poisson_ratio, "poisson_ratio", "-",
                                Range::between(-1.0, 0.5), "initial Poisson's ratio"}};
  }

  constexpr Value shear_modulus() const { return young_modulus / 2.0 / (1.0 + poisson_ratio); }
  constexpr Value bulk_modulus() const { return young_modulus / 3.0 / (1.0 - 2.0 * poisson_ratio); }

  /// W - K/2 (J - 1)^2 in J/m^3. With x = J - 1, l = ln J and r = x - l, which is of second order,
  ///   mu (tr E - x + r) - lambda/2 r (x + l) - mu/3 x^2.
  template <class T>
  T isochoric_energy(const Tensor<T>& H) const {
    const T x = jacobian_minus_one(H), l = log1p(x), r = excess_over_logarithm(l);
    const T mu(shear_modulus());
    return mu * (excess_dilatation(H, cofactor(H)) + r - T(1.0 / 3.0) * x * x) -
           T(0.5 * lambda()) * r * (x + l);
  }

  /// V P (J), the first Piola-Kirchhoff stress times its reference volume V (m^3), for a pressure p (Pa,
  /// tension positive) in place of K (J - 1). It is P = mu (F - F^-T) + lambda l F^-T; F^-T = cof F / J gives
  ///   P = mu (F - cof F) + C cof F,  C = p + (mu x - lambda (r + x^2)) / J - 2/3 mu x.
  /// Near the undeformed state all terms are linear in H or smaller.
  template <class T>
  Tensor<T> weighted_piola(const T& V, const Tensor<T>& H, const VolumeChange<T>& change, const T& p) const {
    const T x = change.J_minus_one;
    const T V_mu = T(shear_modulus()) * V;
    const T C = V * p + (V_mu * x - V * logarithmic_part(x)) / (T(1) + x) - T(2.0 / 3.0) * V_mu * x;
    Tensor<T> P = V_mu * H + (C - V_mu) * cofactor_minus_identity(H);
    for (int i = 0; i < 3; ++i) P(i, i) = P(i, i) + C;
    return P;
  }

  /// V tau (J), the Kirchhoff stress J sigma times its reference volume: with e = F F^T - I
  ///   tau = mu e + (J p - lambda (r + x^2) - 2/3 mu x J) I.
  template <class T>
  Tensor<T> weighted_kirchhoff(const T& V, const Tensor<T>& H, const VolumeChange<T>& change,
                               const T& p) const {
    const T x = change.J_minus_one;
    const T V_mu = T(shear_modulus()) * V;
    Tensor<T> tau = V_mu * left_cauchy_green_minus_identity(H);
    const T mean = (V * p - T(2.0 / 3.0) * V_mu * x) * (T(1) + x) - V * logarithmic_part(x);
    for (int i = 0; i < 3; ++i) tau(i, i) = tau(i, i) + mean;
    return tau;
  }

  /// Bound of the whole tangent; see TangentBound. With b = F F^T it is
  ///   d^2 W = mu tr(L b L^T) + (mu - lambda ln J) tr(L L) + lambda (tr L)^2, |tr(L L)| <= |L|^2.
  template <class T>
  TangentBound<T> tangent_bound(const Tensor<T>& H) const {
    const T mu(shear_modulus());
    const T stretch = T(1) + largest_eigenvalue_bound(left_cauchy_green_minus_identity(H));
    return {.volumetric = T(lambda()),
            .gradient = mu * stretch + abs(mu - T(lambda()) * log1p(jacobian_minus_one(H)))};
  }

  /// The same without K/2 (J - 1)^2.
  template <class T>
  TangentBound<T> isochoric_tangent_bound(const Tensor<T>& H) const {
    return sandglass::tangent_bound(*this, H, jacobian_minus_one(H), T(0), T(0));
  }

 private:
  constexpr Value lambda() const { return bulk_modulus() - 2.0 / 3.0 * shear_modulus(); }

  /// e^l - 1 - l, which is J - 1 - ln J.
  template <class T>
  static T excess_over_logarithm(const T& l) {
    return T(0.5) * l * l * relative_exponential_remainder(l);
  }

  /// lambda (r + x^2) = lambda (J x - ln J), Pa, of second order.
  template <class T>
  T logarithmic_part(const T& x) const {
    return T(lambda()) * (excess_over_logarithm(log1p(x)) + x * x);
  }
};

using CompressibleNeoHookean = CompressibleNeoHookeanOf<double>;

}  // namespace sandglass
