#pragma once

#include "element/one_point.hpp"

namespace sandglass {

/// The uniform strain hexahedron in the Updated Lagrangian formulation: nothing is precomputed. Each step
/// rebuilds mean gradients, volume and hourglass shape vectors from the current coordinates, computes F from
/// F^-1 = I - du/dx, and forces from the Cauchy stress. Its geometry is that of OnePoint, by the same
/// function, so that comparisons measure the formulations, not their implementations.
///
/// An hourglass control of this element is given its whole Deformation and has
///   resistance(now, control, history)  the hourglass resistances Q (N); advances the history,
///   energy(now, control, history)      the stored energy (J) that can be released,
///   stiffness_bound(body, gamma, now, control, history)  a bound (N/m) of the element's tangent, given the
///   body's bound.
struct UpdatedOnePoint {
  static constexpr KinematicsTraits traits{.needs_increment = true, .needs_coordinates = true};

  /// The constants: none.
  template <class T>
  struct Element {};

  static Element<double> precompute(const NodalVectors<double>& /*X*/) { return {}; }

  /// The deformation that the force depends on.
  template <class T>
  struct Deformation {
    Modes<T> x;                    ///< current coordinates, m
    OnePoint::Element<T> current;  ///< h (1/m), c (m) and V (m^3) of the current configuration
    Tensor<T> H;
    VolumeChange<T> change;
    Tensor<T> L;             ///< velocity gradient times the step
    HourglassModes<T> rate;  ///< hourglass velocities times the step, m
    T inverse_step;          ///< 1/s; 0 in quasi-static runs
  };

  template <class Hourglass, class T>
  static Deformation<T> deformation(const ElementMotion<T>& motion, const Element<T>& /*element*/) {
    // Initialised in place: assignments would copy from temporaries. Without a control no rates are needed.
    constexpr bool rates = Hourglass::traits.active;
    Deformation<T> now{.x = motion.X + motion.u,
                       .current = OnePoint::geometry(now.x),
                       .H = displacement_gradient(motion.u, now.current),
                       .change = volume_change(now.H),
                       .L = rates ? OnePoint::mean_gradient(motion.increment, now.current) : Tensor<T>{},
                       .rate = rates ? OnePoint::hourglass_displacements(motion.increment, now.L, now.current)
                                     : HourglassModes<T>{},
                       .inverse_step = motion.inverse_step};
    return now;
  }

  /// Internal forces (N) in modes: f = h v sigma + gamma Q = h (V tau - c^T Q) + Gamma Q.
  template <class Hourglass, class T, class Law>
  static Modes<T> force(const Deformation<T>& now, const Element<T>& /*element*/,
                        const typename Hourglass::template Element<T>& control,
                        typename Hourglass::template History<T>& history, const Law& law) {
    const T p = law.pressure(now.change.J_minus_one);
    const Tensor<T> S = law.weighted_kirchhoff(reference_volume(now), now.H, now.change, p);
    if constexpr (Hourglass::traits.active) {
      return OnePoint::modal_forces(S, Hourglass::resistance(now, control, history), now.current.c,
                                    now.current);
    } else {
      return OnePoint::body_forces(S, now.current);
    }
  }

  template <class Hourglass, class T, class Law>
  static ElementEnergy<T> energy(const ElementMotion<T>& motion, const Element<T>& element,
                                 const typename Hourglass::template Element<T>& control,
                                 const typename Hourglass::template History<T>& history, const Law& law) {
    const auto now = deformation<Hourglass>(motion, element);
    ElementEnergy<T> energy{reference_volume(now) * law.energy(now.H), T(0)};
    if constexpr (Hourglass::traits.active) energy.hourglass = Hourglass::energy(now, control, history);
    return energy;
  }

  /// Reference volume, m^3.
  template <class T>
  static T volume(const ElementMotion<T>& motion, const Element<T>& /*element*/) {
    return OnePoint::geometry(motion.X).V;
  }

  /// det F of this element's mean deformation.
  template <class T>
  static T dilatation(const ElementMotion<T>& motion, const Element<T>& /*element*/) {
    return jacobian_minus_one(displacement_gradient(motion.u, OnePoint::geometry(motion.X + motion.u)));
  }

  /// An upper bound of the largest absolute eigenvalue (N/m) of the tangent stiffness, as for OnePoint, with
  /// h already spatial. In addition, the current geometry bends with the element. Pressure acts on h but
  /// changes with G (`dilatation_gradient`), so that the tangent is not symmetric and its volumetric part is
  /// bounded by |h| |G|; and the gradient h V of the volume, on which pressure acts, also changes with
  /// hourglass displacements (`bending_bound`).
  template <class Hourglass, class T, class Law>
  static T stiffness_bound(const ElementMotion<T>& motion, const Element<T>& element,
                           const typename Hourglass::template Element<T>& control,
                           const typename Hourglass::template History<T>& history, const Law& law) {
    const auto now = deformation<Hourglass>(motion, element);
    const NodalVectors<T> h = OnePoint::nodal_gradients(now.current);
    const NodalVectors<T> G = dilatation_gradient(motion.X, now);
    const TangentBound<T> bound = tangent_bound(law, now.H);
    const T body =
        reference_volume(now) * (max(bound.volumetric, T(0)) * sqrt(double_dot(h, h) * double_dot(G, G)) +
                                 bound.gradient * largest_eigenvalue_bound(transpose(h) * h)) +
        bending_bound(now, law);
    if constexpr (Hourglass::traits.active) {
      return Hourglass::stiffness_bound(body, OnePoint::gamma(h, now.current), now, control, history);
    }
    return body;
  }

  /// The reference volume (m^3) from the current one: v / J, with J^-1 the cube of the known root.
  template <class T>
  static T reference_volume(const Deformation<T>& now) {
    const T r = now.change.inverse_root;
    return now.current.V * (r * r * r);
  }

 private:
  /// G_Ii = d ln J / dx_Ii, 1/m, with J = det F and F^-1 = X^T h the mean of dX/dx: tr(F dF^-1) = F X : dh.
  /// Of x = F X + w the first part is linear in x and gives h; the second, an hourglass displacement of bent
  /// elements, gives the derivative of V h along w over V, since w : h = 0. V h is quadratic in x, so that a
  /// central difference is exact.
  template <class T>
  static NodalVectors<T> dilatation_gradient(const Modes<T>& X, const Deformation<T>& now) {
    const Modes<T> w = now.x - X * transpose(identity<T>() + now.H);
    const OnePoint::Element<T> ahead = OnePoint::geometry(now.x + w), behind = OnePoint::geometry(now.x - w);
    const T half_over_V = T(0.5) / now.current.V;
    return OnePoint::nodal_gradients(now.current) +
           half_over_V *
               (ahead.V * OnePoint::nodal_gradients(ahead) - behind.V * OnePoint::nodal_gradients(behind));
  }

  /// The stiffness (N/m) due to pressure and the change of V h with hourglass displacements v: |V''| |p| V0 J
  /// / V. In modes a_m = x_m / 8, V is a sum of triple products (see OnePoint::geometry); those with
  /// hourglass modes couple two modes of v through one of x, and the largest sum of such couplings of one
  /// mode, 8/3 |a| each, over |v|^2 = 8 sum |a|^2, bounds their norm. The other stresses are of the order of
  /// mu; their effect is smaller than the margin of the bound (eigenvalue_test.cpp).
  template <class T, class Law>
  static T bending_bound(const Deformation<T>& now, const Law& law) {
    const T pressure = abs(law.pressure(now.change.J_minus_one));
    const T J = T(1) + now.change.J_minus_one;
    std::array<T, 6> a;
    for (int m = 0; m < 6; ++m) {
      const T square = now.x(m, 0) * now.x(m, 0) + now.x(m, 1) * now.x(m, 1) + now.x(m, 2) * now.x(m, 2);
      a[static_cast<std::size_t>(m)] = T(0.125) * sqrt(square);
    }
    const T linear = max(max(a[4] + a[5], a[5] + a[3]), a[3] + a[4]);
    const T hourglass =
        max(max(a[1] + a[2] + a[4] + a[5], a[0] + a[2] + a[3] + a[5]), a[0] + a[1] + a[3] + a[4]);
    return T(1.0 / 3.0) * max(linear, hourglass) * pressure * reference_volume(now) * J / now.current.V;
  }

  /// H = D (I - D)^-1 with D = du/dx, which avoids the cancellation of F - I.
  template <class T>
  static Tensor<T> displacement_gradient(const Modes<T>& u, const OnePoint::Element<T>& current) {
    const Tensor<T> D = OnePoint::mean_gradient(u, current);
    return D * inverse(identity<T>() - D);
  }
};

}  // namespace sandglass
