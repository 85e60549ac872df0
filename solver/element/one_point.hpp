#pragma once

#include <algorithm>

#include "element/element_motion.hpp"
#include "element/following.hpp"
#include "material/tangent_bound.hpp"
#include "math/strain.hpp"
#include "mesh/hexahedron.hpp"

namespace sandglass {

/// Energies of one element, J.
template <class T>
struct ElementEnergy {
  T strain;
  T hourglass;
};

/// The uniform strain hexahedron in the Total Lagrangian formulation: one stress from the mean displacement
/// gradient, and an hourglass control for the motions that this gradient does not contain. It is written in
/// modes (modes.hpp): additions replace the dense products with h and gamma, and gamma is not stored.
/// Numbers of equations are the paper's; README.md of this folder lists them.
struct OnePoint {
  /// What is constant in time.
  template <class T>
  struct Element {
    Matrix<T, 6, 3> h;  ///< mean gradients of the first six modes, 1/m (eq. 1); the mode xi eta zeta has none
    Matrix<T, 4, 3> c;  ///< Gamma^T X, m: gamma = Gamma - h c^T (eq. 2); zero on parallelepipeds
    T V;                ///< reference volume, m^3
  };

  static constexpr KinematicsTraits traits{};

  static Element<double> precompute(const NodalVectors<double>& X) { return geometry(to_modes(X)); }

  /// The same from the modes of the nodal coordinates x (m), in closed form: with a_m = x_m / 8 the volume is
  ///   V = 8 ([a1 a2 a3] + ([a1 a6 a5] + [a6 a2 a4] + [a5 a4 a3]) / 3),  [a b c] = a . (b x c),
  /// and h_m = dV/dx_m / V (eq. 1). This is the closed form of B and V of Flanagan and Belytschko 1981,
  /// written in modes; it does not depend on a7.
  template <class T>
  static Element<T> geometry(const Modes<T>& x) {
    std::array<Triple<T>, 6> a;
    for (int m = 0; m < 6; ++m) {
      for (int i = 0; i < 3; ++i) a[static_cast<std::size_t>(m)](i, 0) = T(0.125) * x(m, i);
    }
    const auto third = T(1.0 / 3.0);
    const Triple<T> a65 = third * cross(a[5], a[4]);
    const Triple<T> a46 = third * cross(a[3], a[5]);
    const Triple<T> a54 = third * cross(a[4], a[3]);
    const std::array<Triple<T>, 6> dV{cross(a[1], a[2]) + a65,
                                      cross(a[2], a[0]) + a46,
                                      cross(a[0], a[1]) + a54,
                                      third * (cross(a[5], a[1]) + cross(a[2], a[4])),
                                      third * (cross(a[0], a[5]) + cross(a[3], a[2])),
                                      third * (cross(a[4], a[0]) + cross(a[1], a[3]))};
    const T eighth = double_dot(a[0], dV[0]) + double_dot(a[1], a46) + double_dot(a[2], a54);
    const T scale = T(0.125) / eighth;
    Element<T> element;
    element.V = T(8) * eighth;
    for (int i = 0; i < 3; ++i) {
      for (int m = 0; m < 6; ++m) element.h(m, i) = scale * dV[static_cast<std::size_t>(m)](i, 0);
      for (int b = 0; b < 4; ++b) element.c(b, i) = x(3 + b, i);
    }
    return element;
  }

  /// The mean displacement gradient H_ij = u_Ii h_Ij.
  template <class T>
  static Tensor<T> mean_gradient(const Modes<T>& modes, const Element<T>& element) {
    Tensor<T> H;
    for (int i = 0; i < 3; ++i) {
      for (int j = 0; j < 3; ++j) {
        T sum = modes(0, i) * element.h(0, j);
        for (int m = 1; m < 6; ++m) sum = sum + modes(m, i) * element.h(m, j);
        H(i, j) = sum;
      }
    }
    return H;
  }

  /// Hourglass displacements q = gamma^T u = Gamma^T u - c H^T (m), eq. 11 without its factor 1/sqrt 8: eq. 3
  /// integrated in time from the undeformed state, where u and q are zero (eq. 10).
  template <class T>
  static HourglassModes<T> hourglass_displacements(const Modes<T>& modes, const Tensor<T>& H,
                                                   const Element<T>& element) {
    HourglassModes<T> q;
    for (int a = 0; a < 4; ++a) {
      for (int i = 0; i < 3; ++i) {
        T sum = modes(3 + a, i);
        for (int j = 0; j < 3; ++j) sum = sum - H(i, j) * element.c(a, j);
        q(a, i) = sum;
      }
    }
    return q;
  }

  /// The deformation that the force depends on.
  template <class T>
  struct Deformation {
    Tensor<T> H;  ///< mean displacement gradient
    VolumeChange<T> change;
    HourglassModes<T>
        q;  ///< hourglass displacements, m (r where the control follows); unset without a control
    FollowedDeformation<T> followed;  ///< for a control that follows the mean deformation; else unset
  };

  template <class Hourglass, class T>
  static Deformation<T> deformation(const ElementMotion<T>& motion, const Element<T>& element) {
    Deformation<T> now;
    now.H = mean_gradient(motion.u, element);
    now.change = volume_change(now.H);
    if constexpr (Hourglass::traits.active) now.q = hourglass_displacements(motion.u, now.H, element);
    if constexpr (FollowsDeformation<Hourglass>) {
      now.followed = followed_deformation<Hourglass>(now.H, now.change);
      now.q = convected(now.q, now.followed);
    }
    return now;
  }

  /// Internal forces (N) in modes. The paper adds to the force of the stress that of its hourglass control,
  ///   f = V h P^T + k gamma gamma^T u,   the second term being eq. 14 (eq. 13 by components).
  /// With q = gamma^T u (eq. 11) and Q = k q (eq. 4 and eq. 12; each control has its own Q) that term is
  /// gamma Q (eq. 5), and since gamma = Gamma - h c^T (eq. 2), both terms share one product with h:
  ///   f = h (V P^T) + (Gamma - h c^T) Q = h (V P^T - c^T Q) + Gamma Q.
  /// In modes Gamma Q is an addition to four rows, and H, already known, gives q: 168 operations for the
  /// control in place of the 360 of the two dense products (`paper_hourglass_force`).
  ///
  /// The energy phi E0(F^-1 q) of a control that follows the deformation also changes with F, by
  /// -sum_a Q_a (x) r_a and by phi: the former is the same force with c + r in place of c, the latter a
  /// stress.
  template <class Hourglass, class T, class Law>
  static Modes<T> force(const Deformation<T>& now, const Element<T>& element,
                        const typename Hourglass::template Element<T>& control, NoHistory<T>& /*history*/,
                        const Law& law) {
    const T p = law.pressure(now.change.J_minus_one);
    const Tensor<T> VP = transpose(law.weighted_piola(element.V, now.H, now.change, p));
    if constexpr (FollowsDeformation<Hourglass>) {
      const HourglassModes<T> s = Hourglass::resistance(now.q, control);
      const HourglassModes<T> Q = turned_back<Hourglass>(s, now.followed);
      if constexpr (GrowsWithDeformation<Hourglass>) {
        return modal_forces(VP + stress_of_phi(now.q, s, now.H, now.followed), Q, element.c + now.q, element);
      } else {
        return modal_forces(VP, Q, element.c + now.q, element);
      }
    } else if constexpr (Hourglass::traits.active) {
      return modal_forces(VP, Hourglass::resistance(now.q, control), element.c, element);
    } else {
      return body_forces(VP, element);
    }
  }

  template <class Hourglass, class T, class Law>
  static ElementEnergy<T> energy(const ElementMotion<T>& motion, const Element<T>& element,
                                 const typename Hourglass::template Element<T>& control,
                                 const NoHistory<T>& /*history*/, const Law& law) {
    const Tensor<T> H = mean_gradient(motion.u, element);
    ElementEnergy<T> energy{element.V * law.energy(H), T(0)};
    if constexpr (Hourglass::traits.active) {
      const HourglassModes<T> q = hourglass_displacements(motion.u, H, element);
      if constexpr (FollowsDeformation<Hourglass>) {
        const auto followed = followed_deformation<Hourglass>(H, volume_change(H));
        energy.hourglass = hourglass_energy<Hourglass>(convected(q, followed), control);
        if constexpr (GrowsWithDeformation<Hourglass>) energy.hourglass = followed.phi * energy.hourglass;
      } else {
        energy.hourglass = hourglass_energy<Hourglass>(q, control);
      }
    }
    return energy;
  }

  /// Reference volume, m^3.
  template <class T>
  static T volume(const ElementMotion<T>& /*motion*/, const Element<T>& element) {
    return element.V;
  }

  /// The element's volume over its reference volume: det F of the mean deformation.
  template <class T>
  static T dilatation(const ElementMotion<T>& motion, const Element<T>& element) {
    return jacobian_minus_one(mean_gradient(motion.u, element));
  }

  /// An upper bound of the largest eigenvalue (N/m) of the tangent stiffness. The body's part follows from
  /// the spatial gradients h F^-1; on an undeformed cube it is the exact eigenvalue, whereas eq. 7 and eq. 8
  /// give (lambda + 2 mu) |h|^2. The control's part is added, which is safe whatever the angle between their
  /// modes.
  template <class Hourglass, class T, class Law>
  static T stiffness_bound(const ElementMotion<T>& motion, const Element<T>& element,
                           const typename Hourglass::template Element<T>& control,
                           const NoHistory<T>& /*history*/, const Law& law) {
    const Tensor<T> H = mean_gradient(motion.u, element);
    const NodalVectors<T> h = nodal_gradients(element);
    const Tensor<T> inverse_F = inverse(identity<T>() + H);
    const NodalVectors<T> g = h * inverse_F;
    const T body = element.V * gradient_bound(tangent_bound(law, H), g);
    if constexpr (FollowsDeformation<Hourglass>) {
      const auto followed = followed_deformation<Hourglass>(H, volume_change(H));
      const HourglassModes<T> r = convected(hourglass_displacements(motion.u, H, element), followed);
      const Matrix<T, 8, 4> current_gamma = gamma(h, element) - h * transpose(r);
      return body + following_bound<Hourglass>(current_gamma, g, r, H, followed, control);
    } else if constexpr (Hourglass::traits.active) {
      return body + Hourglass::stiffness_bound(gamma(h, element), control);
    }
    return body;
  }

  /// h S + gamma Q (N) in modes, for a stress S = V P^T (J), hourglass resistances Q (N) and
  /// gamma = Gamma - h c^T; gamma Q is eq. 5 without its factor 1/sqrt 8.
  template <class T>
  static Modes<T> modal_forces(const Tensor<T>& S, const HourglassModes<T>& Q, const Matrix<T, 4, 3>& c,
                               const Element<T>& element) {
    Modes<T> f = body_forces(S - transpose(c) * Q, element);
    for (int a = 0; a < 4; ++a) {
      for (int i = 0; i < 3; ++i) f(3 + a, i) = f(3 + a, i) + Q(a, i);
    }
    return f;
  }

  /// h S (N) for each mode, zero in the mode xi eta zeta.
  template <class T>
  static Modes<T> body_forces(const Tensor<T>& S, const Element<T>& element) {
    const Matrix<T, 6, 3> hS = element.h * S;
    Modes<T> f;
    for (int i = 0; i < 3; ++i) {
      for (int m = 0; m < 6; ++m) f(m, i) = hS(m, i);
      f(6, i) = T(0);
    }
    return f;
  }

  /// The mean gradients h_Ii (1/m) at the nodes, from their modes.
  template <class T>
  static NodalVectors<T> nodal_gradients(const Element<T>& element) {
    return from_modes(body_forces(identity<T>(), element));
  }

  /// Hourglass shape vectors gamma_Ia (eq. 2).
  template <class T>
  static Matrix<T, 8, 4> gamma(const NodalVectors<T>& h, const Element<T>& element) {
    constexpr auto Gamma = hourglass_base_vectors();
    Matrix<T, 8, 4> gamma = h * transpose(element.c);
    for (int I = 0; I < 8; ++I) {
      for (int a = 0; a < 4; ++a) gamma(I, a) = T(Gamma(I, a)) - gamma(I, a);
    }
    return gamma;
  }
};

}  // namespace sandglass
