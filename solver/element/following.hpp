#pragma once

#include "element/modes.hpp"
#include "material/neo_hookean.hpp"
#include "material/tangent_bound.hpp"
#include "math/strain.hpp"

namespace sandglass {

/// A control that follows the mean deformation states `follows_deformation`. Its energy E0 at small
/// displacements, which must be quadratic, becomes
///   E(q, F) = phi E0(r),  r_a = F^-1 q_a,  phi = J^(-2/3) tr(F^T F) / 3.
/// Here r is q in base vectors that move with the body: the volume change due to the fluctuation is tr(F^-1
/// grad w) = sum_a r_a . grad w_a, so that a nearly incompressible element behaves as when undeformed,
/// however far it is deformed and rotated. phi is the growth of the isochoric neo-Hookean energy of
/// fluctuations: the mean of its exact second variation over all fluctuations F^-1 grad w of one size is phi
/// times the mean in the undeformed state. A control whose energy grows in this way states
/// `grows_with_deformation`; for others phi = 1. Forces are the derivatives of E, so that momentum and
/// angular momentum are balanced.
template <class Hourglass>
concept FollowsDeformation = Hourglass::traits.follows_deformation;
template <class Hourglass>
concept GrowsWithDeformation = FollowsDeformation<Hourglass> && Hourglass::traits.grows_with_deformation;

/// The mean deformation in the form that a control uses to follow it.
template <class T>
struct FollowedDeformation {
  Tensor<T> inverse_F;
  T J_to_minus_two_thirds;
  T phi;  ///< unset if the control does not grow
};

/// The mean deformation of a displacement gradient H.
template <class Hourglass, class T>
FollowedDeformation<T> followed_deformation(const Tensor<T>& H, const VolumeChange<T>& change) {
  const T r = change.inverse_root;
  FollowedDeformation<T> followed;
  followed.J_to_minus_two_thirds = r * r;
  followed.inverse_F = (followed.J_to_minus_two_thirds * r) * transpose(cofactor(identity<T>() + H));
  if constexpr (GrowsWithDeformation<Hourglass>) {
    const T third(1.0 / 3.0);
    followed.phi = followed.J_to_minus_two_thirds * (T(1) + third * (T(2) * trace(H) + double_dot(H, H)));
  }
  return followed;
}

/// r_a = F^-1 q_a.
template <class T>
HourglassModes<T> convected(const HourglassModes<T>& q, const FollowedDeformation<T>& followed) {
  return q * transpose(followed.inverse_F);
}

/// dE/dq_a = phi F^-T dE0/dr_a for resistances s = dE0/dr (N).
template <class Hourglass, class T>
HourglassModes<T> turned_back(const HourglassModes<T>& s, const FollowedDeformation<T>& followed) {
  if constexpr (GrowsWithDeformation<Hourglass>) {
    return s * (followed.phi * followed.inverse_F);
  } else {
    return s * followed.inverse_F;
  }
}

/// E0 (dphi/dF)^T for 2 E0 = r . s, in J; dphi/dF = 2/3 (J^(-2/3) F - phi F^-T).
template <class T>
Tensor<T> stress_of_phi(const HourglassModes<T>& r, const HourglassModes<T>& s, const Tensor<T>& H,
                        const FollowedDeformation<T>& followed) {
  const T e = T(1.0 / 3.0) * double_dot(r, s);
  const T a = e * followed.J_to_minus_two_thirds;
  const T b = e * followed.phi;
  Tensor<T> stress;
  for (int j = 0; j < 3; ++j) {
    for (int i = 0; i < 3; ++i) stress(j, i) = a * H(i, j) - b * followed.inverse_F(j, i);
    stress(j, j) = stress(j, j) + a;
  }
  return stress;
}

/// The energy (J) of a control at hourglass displacements q (m): q . Q / 2, unless the control declares it.
template <class Hourglass, class T>
T hourglass_energy(const HourglassModes<T>& q, const typename Hourglass::template Element<T>& control) {
  if constexpr (requires { Hourglass::energy(q, control); }) {
    return Hourglass::energy(q, control);
  } else {
    return T(0.5) * double_dot(q, Hourglass::resistance(q, control));
  }
}

/// A bound (N/m) of the tangent of E. A displacement v of the nodes has the spatial gradient L = v^T g and
/// changes r by F^-1 v^T gamma, with g = h F^-1 and gamma the shape vectors of the current configuration.
/// With s = dE0/dr, Q = s F^-1 and K = E0'',
///   E'' = phi (dr K dr - 2 tr(L (v^T gamma Q))) + 2 dphi (gamma Q : v) + E0 d2phi,
/// where dphi = 2/3 J^(-2/3) dev(F F^T) : L, and phi - 1 is the energy of a law whose tangent is bounded. The
/// control's own bound depends on gamma; F^-1 scales it.
template <class Hourglass, class T>
T following_bound(const Matrix<T, 8, 4>& gamma, const NodalVectors<T>& g, const HourglassModes<T>& r,
                  const Tensor<T>& H, const FollowedDeformation<T>& followed,
                  const typename Hourglass::template Element<T>& control) {
  const NodalVectors<T> gamma_Q = gamma * (Hourglass::resistance(r, control) * followed.inverse_F);
  const T gg = largest_eigenvalue_bound(transpose(g) * g);
  const T material = largest_eigenvalue_bound(transpose(followed.inverse_F) * followed.inverse_F) *
                     Hourglass::stiffness_bound(gamma, control);
  const T geometric = T(2) * sqrt(gg * largest_eigenvalue_bound(transpose(gamma_Q) * gamma_Q));
  if constexpr (!GrowsWithDeformation<Hourglass>) return material + geometric;
  const Tensor<T> d = followed.J_to_minus_two_thirds * deviator(left_cauchy_green_minus_identity(H));
  const T mixed = T(4.0 / 3.0) * sqrt(double_dot(d, d) * gg * double_dot(gamma_Q, gamma_Q));
  constexpr NeoHookean phi_minus_one{.young_modulus = 4.0 / 3.0, .poisson_ratio = 0.0};  // mu/2 = 1/3
  const T growth =
      hourglass_energy<Hourglass>(r, control) * gradient_bound(phi_minus_one.isochoric_tangent_bound(H), g);
  return followed.phi * (material + geometric) + mixed + growth;
}

}  // namespace sandglass
