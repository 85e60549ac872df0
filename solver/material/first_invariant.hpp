#pragma once

#include <cmath>

#include "material/quadratic_volume.hpp"
#include "material/tangent_bound.hpp"
#include "math/strain.hpp"

/// Isochoric energies w(I1bar) of the first invariant I1bar = J^(-2/3) tr(F^T F): their stress is neo-Hookean
/// with a shear modulus that depends on the strain, mu = 2 w'(I1bar). They are written in terms of the
/// displacement gradient H = F - I, so that nothing cancels near the undeformed state.
namespace sandglass {

/// A third of I1bar - 3, with all its digits. With (tr(F F^T)/3)^3 = J^2 (1 + r) the difference of two
/// numbers near 3 becomes 3 ((1 + r)^(1/3) - 1), and r = (d:d (1 + tr(e)/3) / 2 - det d) / J^2 is of second
/// order term by term.
template <class T>
T third_of_first_invariant_growth(const Tensor<T>& H) {
  const Tensor<T> e = left_cauchy_green_minus_identity(H);
  const Tensor<T> d = deviator(e);
  const T J = T(1) + jacobian_minus_one(H);
  const T r = (T(0.5) * double_dot(d, d) * (T(1) + T(1.0 / 3.0) * trace(e)) - determinant(d)) / (J * J);
  return expm1(T(1.0 / 3.0) * log1p(r));
}

/// I1bar - 3 for a modulus that depends on it, without transcendental functions: its absolute error is the
/// roundoff of 3.
template <class T>
T first_invariant_growth(const Tensor<T>& H, const VolumeChange<T>& change) {
  const T r2 = change.inverse_root * change.inverse_root;
  return T(3) * (r2 - T(1)) + r2 * (T(2) * trace(H) + double_dot(H, H));
}

/// V P (Pa m^3) for V mu and V p (Pa m^3): P = a F + (p - a tr(F^T F) / (3 J)) cof F with a = mu J^(-2/3).
/// With cof F = (1 + tr H) I - H^T + cof H the unit tensors cancel analytically, and the rest is linear in H
/// near the undeformed state:
///   P = c (I - W) + a (H + W),  W = H^T - tr H I - cof H,  c = p + a (3 (J - 1) - 2 tr H - H:H) / (3 J).
/// H + W is formed first, so that a small rotation, where H^T = -H, leaves only the roundoff of its square.
template <class T>
Tensor<T> first_invariant_piola(const T& V_mu, const T& V_p, const Tensor<T>& H,
                                const VolumeChange<T>& change) {
  const T r = change.inverse_root;
  const T r2 = r * r;
  const T a = V_mu * r2;
  const T tr = trace(H);
  const T c =
      V_p + (T(1.0 / 3.0) * a) * (r2 * r) * (T(3) * change.J_minus_one - (T(2) * tr + double_dot(H, H)));
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

/// V tau (Pa m^3) for V mu, V p and e = F F^T - I: a dev(F F^T) + p J I.
template <class T>
Tensor<T> first_invariant_kirchhoff(const T& V_mu, const T& V_p, const Tensor<T>& e,
                                    const VolumeChange<T>& change) {
  const T a = V_mu * (change.inverse_root * change.inverse_root);
  Tensor<T> tau = a * deviator(e);
  const T mean = V_p * (T(1) + change.J_minus_one);
  for (int i = 0; i < 3; ++i) tau(i, i) = tau(i, i) + mean;
  return tau;
}

/// Bound of mu/2 d^2 I1bar for a modulus mu >= 0 (Pa); see TangentBound. Here b = F F^T and m = mu J^(-2/3).
template <class T>
TangentBound<T> first_invariant_tangent_bound(const T& mu, const Tensor<T>& H) {
  const Tensor<T> e = left_cauchy_green_minus_identity(H);
  const T root = inverse_cube_root(T(1) + jacobian_minus_one(H));
  const T m = mu * root * root;
  return isochoric_stress_bound(m * (T(1) + T(1.0 / 3.0) * trace(e)), m * deviator(e));
}

/// The same for w(I1bar) with a modulus mu = 2 w' and a second derivative w'' (Pa):
/// d^2 w = w' d^2 x + w'' (dx)^2, and dx = 2 J^(-2/3) dev b : L involves only the deviator of L.
template <class T>
TangentBound<T> first_invariant_tangent_bound(const T& mu, const T& second_derivative, const Tensor<T>& H) {
  const Tensor<T> d = deviator(left_cauchy_green_minus_identity(H));
  const T r = volume_change(H).inverse_root;
  const T r2 = r * r;
  const T steepening = max(second_derivative, T(0)) * (T(4) * r2 * r2 * double_dot(d, d));
  return first_invariant_tangent_bound(mu, H) + change_of_shape_bound(steepening);
}

/// The common base of laws with such an energy. A law derives from FirstInvariant of itself and defines
/// bulk_modulus(), isochoric_energy(H), isochoric_tangent_bound(H) by one of the two functions above, and
/// current_modulus(H, change), the shear modulus 2 w'(I1bar) in Pa; it inherits the functions below.
template <class Law>
struct FirstInvariant : QuadraticVolume<Law> {
  static constexpr LawTraits traits{};

  /// V P (J), the first Piola-Kirchhoff stress times its reference volume V (m^3), for a pressure p (Pa,
  /// tension positive) that may differ from the law's.
  template <class T>
  Tensor<T> weighted_piola(const T& V, const Tensor<T>& H, const VolumeChange<T>& change, const T& p) const {
    return first_invariant_piola(V * law().current_modulus(H, change), V * p, H, change);
  }

  /// V tau (J), the Kirchhoff stress J sigma times its reference volume, for the same arguments.
  template <class T>
  Tensor<T> weighted_kirchhoff(const T& V, const Tensor<T>& H, const VolumeChange<T>& change,
                               const T& p) const {
    return first_invariant_kirchhoff(V * law().current_modulus(H, change), V * p,
                                     left_cauchy_green_minus_identity(H), change);
  }

 private:
  constexpr const Law& law() const { return static_cast<const Law&>(*this); }
};

}  // namespace sandglass
