#pragma once

#include <string_view>
#include <tuple>

#include "base/parameter.hpp"
#include "material/tangent_bound.hpp"
#include "math/strain.hpp"

namespace sandglass {

/// The nearly incompressible neo-Hookean law of ABAQUS and of the TLED paper,
///   W = mu/2 (J^(-2/3) tr(F^T F) - 3) + K/2 (J - 1)^2,
/// written in the displacement gradient H = F - I so that nothing cancels near rest. Energies in J/m^3,
/// stresses in Pa, per reference volume.
struct NeoHookean {
  static constexpr std::string_view name = "neo-hookean";
  static constexpr std::string_view summary = "isochoric neo-Hookean with a quadratic volumetric energy";

  double young_modulus = 0.0;
  double poisson_ratio = 0.0;

  static constexpr auto parameters() {
    return std::tuple{Parameter{&NeoHookean::young_modulus, "young_modulus", "Pa", Range::positive(),
                                "Young's modulus at rest"},
                      Parameter{&NeoHookean::poisson_ratio, "poisson_ratio", "-", Range::between(-1.0, 0.5),
                                "Poisson's ratio at rest"}};
  }

  constexpr double shear_modulus() const { return young_modulus / 2.0 / (1.0 + poisson_ratio); }
  constexpr double bulk_modulus() const { return young_modulus / 3.0 / (1.0 - 2.0 * poisson_ratio); }

  /// mu/2 (J^(-2/3) tr(F^T F) - 3). With (tr(F F^T)/3)^3 = J^2 (1 + r) the difference of two numbers near 3
  /// becomes 3/2 mu ((1 + r)^(1/3) - 1), and r = (d:d (1 + tr(e)/3) / 2 - det d) / J^2 is of second order
  /// term by term.
  template <class T>
  T isochoric_energy(const Tensor<T>& H) const {
    const Tensor<T> e = left_cauchy_green_minus_identity(H);
    const Tensor<T> d = deviator(e);
    const T J = T(1) + jacobian_minus_one(H);
    const T r = (T(0.5) * double_dot(d, d) * (T(1) + T(1.0 / 3.0) * trace(e)) - determinant(d)) / (J * J);
    return T(1.5 * shear_modulus()) * expm1(T(1.0 / 3.0) * log1p(r));
  }

  /// K/2 (J - 1)^2 of J - 1.
  template <class T>
  T volumetric_energy(const T& J_minus_one) const {
    return T(0.5 * bulk_modulus()) * J_minus_one * J_minus_one;
  }

  /// d(volumetric energy)/dJ, the mean Cauchy stress (tension positive).
  template <class T>
  T pressure(const T& J_minus_one) const {
    return T(bulk_modulus()) * J_minus_one;
  }

  /// d^2(volumetric energy)/dJ^2.
  template <class T>
  T bulk_tangent(const T& /*J_minus_one*/) const {
    return T(bulk_modulus());
  }

  /// V P, the first Piola-Kirchhoff stress times the reference volume (m^3) that it acts on, with a pressure
  /// p (Pa, tension positive) that need not be the law's own: P = a F + (p - a tr(F^T F) / (3 J)) cof F with
  /// a = mu J^(-2/3). With cof F = (1 + tr H) I - H^T + cof H the unit tensors cancel by hand, and what is
  /// left is linear in H at rest:
  ///   P = c (I - W) + a (H + W),  W = H^T - tr H I - cof H,  c = p + a (3 (J - 1) - 2 tr H - H:H) / (3 J).
  /// H + W is formed first, so that a small rotation, where H^T = -H, leaves no more than its square's
  /// roundoff.
  template <class T>
  Tensor<T> weighted_piola(const T& V, const Tensor<T>& H, const VolumeChange<T>& change, const T& p) const {
    const T r = change.inverse_root;
    const T r2 = r * r;
    const T a = (T(shear_modulus()) * V) * r2;
    const T tr = trace(H);
    const T c =
        V * p + (T(1.0 / 3.0) * a) * (r2 * r) * (T(3) * change.J_minus_one - (T(2) * tr + double_dot(H, H)));
    const Tensor<T> cof_H = cofactor(H);
    Tensor<T> P;  // times V
    for (int i = 0; i < 3; ++i) {
      for (int j = 0; j < 3; ++j) {
        T w = H(j, i) - cof_H(i, j);
        if (i == j) w = w - tr;
        P(i, j) = a * (H(i, j) + w) - c * w;
      }
      P(i, i) = P(i, i) + c;
    }
    return P;
  }

  /// V tau, the Kirchhoff stress J sigma times the reference volume that it acts on: a dev(F F^T) + p J I.
  template <class T>
  Tensor<T> weighted_kirchhoff(const T& V, const Tensor<T>& H, const VolumeChange<T>& change,
                               const T& p) const {
    const T a = (T(shear_modulus()) * V) * (change.inverse_root * change.inverse_root);
    Tensor<T> tau = a * deviator(left_cauchy_green_minus_identity(H));
    const T mean = V * p * (T(1) + change.J_minus_one);
    for (int i = 0; i < 3; ++i) tau(i, i) = tau(i, i) + mean;
    return tau;
  }

  /// The isochoric part of the first Piola-Kirchhoff stress.
  template <class T>
  Tensor<T> isochoric_piola(const Tensor<T>& H) const {
    return weighted_piola(T(1), H, volume_change(H), T(0));
  }

  /// The strain energy density.
  template <class T>
  T energy(const Tensor<T>& H) const {
    return isochoric_energy(H) + volumetric_energy(jacobian_minus_one(H));
  }

  /// The first Piola-Kirchhoff stress, dW/dF.
  template <class T>
  Tensor<T> piola(const Tensor<T>& H) const {
    const VolumeChange<T> change = volume_change(H);
    return weighted_piola(T(1), H, change, pressure(change.J_minus_one));
  }

  /// Bound of the isochoric tangent in the current configuration; see TangentBound. With b = F F^T and
  /// m = mu J^(-2/3), d^2 W = m [tr(L b L^T) - 4/3 tr L tr(L b) + 2/9 tr b (tr L)^2 + 1/3 tr b tr(L L)];
  /// b is split into its mean and deviator, and the mixed term is halved between (tr L)^2 and |L|^2.
  template <class T>
  TangentBound<T> isochoric_tangent_bound(const Tensor<T>& H) const {
    const Tensor<T> e = left_cauchy_green_minus_identity(H);
    const Tensor<T> d = deviator(e);
    const T deviation = sqrt(double_dot(d, d));
    const T trace_b = T(3) + trace(e);
    const T root = inverse_cube_root(T(1) + jacobian_minus_one(H));
    const T m = T(shear_modulus()) * root * root;
    return {.volumetric = m * (T(2.0 / 3.0) * deviation - T(2.0 / 9.0) * trace_b),
            .gradient = m * (T(2.0 / 3.0) * trace_b + T(std::sqrt(2.0 / 3.0) + 2.0 / 3.0) * deviation)};
  }
};

}  // namespace sandglass
