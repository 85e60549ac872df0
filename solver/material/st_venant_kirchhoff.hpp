#pragma once

#include <algorithm>
#include <cmath>
#include <string_view>
#include <tuple>

#include "base/parameter.hpp"
#include "material/quadratic_volume.hpp"
#include "material/tangent_bound.hpp"

namespace sandglass {

/// The law of St. Venant and Kirchhoff, Hooke's law of the Green strain E = (F^T F - I)/2,
///   W = K/2 tr^2 E + mu |dev E|^2.
/// It is meant for small strains and large rotations. In compression it softens, and becomes unstable at the
/// stretch 1/sqrt(3).
///
/// It is not the sum of an isochoric and a volumetric part. Its isochoric energy here is W - K/2 (J - 1)^2,
/// whose undeformed tangent is isochoric; elements that average K/2 (J - 1)^2 therefore average the pressure.
/// At large strains that part is not positive: within such an element K (tr E)^2 acts against K (J - 1)^2,
/// and the element becomes unstable when K |dev b|^2 exceeds a few mu. A block stretched and sheared with
/// tl-mean-dilatation withstood 30 % at nu = 0.25, 20 % at 0.3, 10 % at 0.4 and less at 0.45. Other methods
/// use the whole energy and are not affected.
template <class Value>
struct StVenantKirchhoffOf : QuadraticVolume<StVenantKirchhoffOf<Value>> {
  static constexpr std::string_view name = "st-venant-kirchhoff";
  static constexpr std::string_view summary = "Hooke's law of the Green strain; soft in strong compression";
  static constexpr LawTraits traits{.splits_volume = false, .softening_stretch = 0.57735026918962576};

  Value young_modulus = 0.0;
  Value poisson_ratio = 0.0;

  static constexpr auto parameters() {
    return std::tuple{Parameter{&StVenantKirchhoffOf::young_modulus, "young_modulus", "Pa", Range::positive(),
                                "initial Young's modulus"},
                      Parameter{&StVenantKirchhoffOf::poisson_ratio, "poisson_ratio", "-",
                                Range::between(-1.0, 0.5), "initial Poisson's ratio"}};
  }

  constexpr Value shear_modulus() const { return young_modulus / 2.0 / (1.0 + poisson_ratio); }
  constexpr Value bulk_modulus() const { return young_modulus / 3.0 / (1.0 - 2.0 * poisson_ratio); }

  /// W - K/2 (J - 1)^2 in J/m^3, the difference of the squares as a product: tr E - (J - 1) is of second
  /// order.
  template <class T>
  T isochoric_energy(const Tensor<T>& H) const {
    const T tr_E = green_trace(H);
    const Tensor<T> d = deviator(green_strain(H));
    return T(0.5 * bulk_modulus()) * (excess_dilatation(H, cofactor(H)) * (tr_E + jacobian_minus_one(H))) +
           T(shear_modulus()) * double_dot(d, d);
  }

  /// V P (J), the first Piola-Kirchhoff stress times its reference volume V (m^3), for a pressure p (Pa,
  /// tension positive) in place of K (J - 1):
  ///   P = (p + K g) cof F + K tr E (F - cof F) + 2 mu F dev E,  g = tr E - (J - 1).
  /// Near the undeformed state all terms are linear in H or smaller; with p = K (J - 1) it is F S,
  /// S = K tr E I + 2 mu dev E.
  template <class T>
  Tensor<T> weighted_piola(const T& V, const Tensor<T>& H, const VolumeChange<T>& /*change*/,
                           const T& p) const {
    const T VK = T(bulk_modulus()) * V;
    const Tensor<T> cof_H = cofactor(H);
    const T c = V * p + VK * excess_dilatation(H, cof_H);
    const T s = VK * green_trace(H);
    const T tr = trace(H);
    const Tensor<T> S = (T(2.0 * shear_modulus()) * V) * deviator(green_strain(H));
    Tensor<T> P = S + H * S;
    for (int i = 0; i < 3; ++i) {
      for (int j = 0; j < 3; ++j) {
        T w = H(j, i) - cof_H(i, j);  // I - cof F
        if (i == j) w = w - tr;
        P(i, j) = P(i, j) + (s * (H(i, j) + w) - c * w);
      }
      P(i, i) = P(i, i) + c;
    }
    return P;
  }

  /// V tau (J), the Kirchhoff stress J sigma times its reference volume: with e = F F^T - I
  ///   tau = (p + K g) J I + K tr E (e - (J - 1) I) + mu (I + e) (e - 2/3 tr E I).
  template <class T>
  Tensor<T> weighted_kirchhoff(const T& V, const Tensor<T>& H, const VolumeChange<T>& change,
                               const T& p) const {
    const T VK = T(bulk_modulus()) * V;
    const T V_mu = T(shear_modulus()) * V;
    const Tensor<T> e = left_cauchy_green_minus_identity(H);
    const T tr_E = T(0.5) * trace(e);
    const T s = VK * tr_E;
    Tensor<T> tau;
    const T linear = s + V_mu * (T(1) - T(2.0 / 3.0) * tr_E);
    for (int i = 0; i < 3; ++i) {
      for (int j = i; j < 3; ++j) {
        tau(i, j) = linear * e(i, j) + V_mu * (e(i, 0) * e(0, j) + e(i, 1) * e(1, j) + e(i, 2) * e(2, j));
        tau(j, i) = tau(i, j);
      }
    }
    const T mean = (V * p + VK * excess_dilatation(H, cofactor(H))) * (T(1) + change.J_minus_one) -
                   s * change.J_minus_one - T(2.0 / 3.0) * V_mu * tr_E;
    for (int i = 0; i < 3; ++i) tau(i, i) = tau(i, i) + mean;
    return tau;
  }

  /// Bound of the whole tangent; see TangentBound. With b = F F^T, tau = F S F^T and D the symmetric part of
  /// L it is d^2 W = tr(L tau L^T) + lambda (b : D)^2 + 2 mu tr(b D b D). The largest eigenvalues bound the
  /// first and the last term. In the second b = m I + d, and the mixed term is split by
  /// 2 (tr L) d : D <= sqrt(3) |d| |dev L|^2 + |d| (tr L)^2 / sqrt(3), |dev L|^2 = |L|^2 - (tr L)^2 / 3.
  template <class T>
  TangentBound<T> tangent_bound(const Tensor<T>& H) const {
    const Value lambda = bulk_modulus() - 2.0 / 3.0 * shear_modulus();
    const T mu(shear_modulus());
    const Tensor<T> e = left_cauchy_green_minus_identity(H);
    const Tensor<T> dev_e = deviator(e);
    const T m = T(1) + T(1.0 / 3.0) * trace(e);
    const T d = sqrt(double_dot(dev_e, dev_e));
    const Tensor<T> tau = (T(0.5 * lambda) * trace(e)) * (identity<T>() + e) + mu * (e + e * e);
    const T stretch = m + T(std::sqrt(2.0 / 3.0)) * d;  // largest eigenvalue of b
    const T stiff(max(lambda, Value(0.0)));
    const T last = T(2) * mu * (stretch * stretch);
    const T gradient = largest_eigenvalue_bound(tau) + last + stiff * d * (T(std::sqrt(3.0)) * m + d);
    const T volumetric = stiff * (m * m - T(1.0 / 3.0) * (d * d));
    // Pressure makes tau negative, but a negative factor of |L|^2 is no bound; by |L|^2 >= (tr L)^2 / 3 it
    // goes to the trace. The last term remains, so that an unstable law still has a finite step.
    return {.volumetric = volumetric + T(1.0 / 3.0) * min(gradient - last, T(0)),
            .gradient = max(gradient, last)};
  }

  /// The same without K/2 (J - 1)^2.
  template <class T>
  TangentBound<T> isochoric_tangent_bound(const Tensor<T>& H) const {
    return sandglass::tangent_bound(*this, H, jacobian_minus_one(H), T(0), T(0));
  }

 private:
  /// E = (H + H^T + H^T H)/2.
  template <class T>
  static Tensor<T> green_strain(const Tensor<T>& H) {
    return T(0.5) * left_cauchy_green_minus_identity(transpose(H));
  }
};

using StVenantKirchhoff = StVenantKirchhoffOf<double>;

}  // namespace sandglass
