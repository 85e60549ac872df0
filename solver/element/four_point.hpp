#pragma once

#include <array>
#include <numbers>

#include "element/one_point.hpp"
#include "element/point_bound.hpp"
#include "material/point_stress.hpp"

namespace sandglass {

/// The hexahedron with four points: half the cost of eight in the law, and the memory of one. The fluctuation
/// of the displacement gradient is that of the parallelepiped whose inverse Jacobian is the mean one, sum_a
/// q_a/8 (x) dw_a/dX with w_1..3 = eta zeta, xi zeta, xi eta, evaluated at every other corner of the Gauss
/// rule: (- - -), (+ + -), (+ - +), (- + +) over sqrt 3. There the means of xi, of xi eta and of xi^2 - 1/3
/// are zero, so that the mean gradient remains exact, and the energy of the fluctuation is correct to second
/// order on parallelepipeds, at every deformation and for every law. The element has one pressure, like the
/// mean-dilatation element.
///
/// The fourth mode would couple with the others through the mean of xi eta zeta, which is not zero over
/// alternate corners. It is left to an hourglass control.
///
/// The other four corners are equally good, and differ to third order in the fluctuation. `side` decides by
/// the element's shape, never by its numbering. No such rule can be symmetric under reflection, since a
/// mirror maps a cuboid to itself and its alternate corners to the others, nor can it rotate with an element
/// of equal edges.
struct FourPoint : OnePoint {
  static constexpr KinematicsTraits traits{.points = 4, .averages_pressure = true};

  /// What is constant in time: the data of one point, and the side of the points.
  template <class T>
  struct Element : OnePoint::Element<T> {
    T reach;  ///< the points' coordinate, 1/sqrt 3; negative for the other four corners
  };

  static Element<double> precompute(const NodalVectors<double>& X) { return geometry(to_modes(X)); }

  /// The same from the modes of the nodal coordinates x (m).
  template <class T>
  static Element<T> geometry(const Modes<T>& x) {
    return {OnePoint::geometry(x), T(gauss_coordinate) * side(x)};
  }

  /// 1 or -1: which alternate corners have the points, from the modes of the nodal coordinates x (m). Axes of
  /// different length, shear or taper have a handedness, the sign of the permutation that sorts them. Like
  /// the corners, it changes sign with the numbering and rotates with the element. If two axes are alike, the
  /// corner farthest along a fixed direction has a point.
  template <class T>
  static T side(const Modes<T>& x) {
    const auto product = [&](int m, int n) {
      return x(m, 0) * x(n, 0) + x(m, 1) * x(n, 1) + x(m, 2) * x(n, 2);
    };
    const auto measure = [&](int k, int l, int m) {
      return product(k, k) + abs(product(l, m)) + product(3 + k, 3 + k);
    };
    const T a = measure(0, 1, 2), b = measure(1, 2, 0), c = measure(2, 0, 1), sum = a + b + c;
    const T handedness = (a - b) * (b - c) * (c - a) / (sum * sum * sum);
    // No integer combination of these components is zero: no edge of a regular mesh is perpendicular to them.
    const auto along = [&](int k) {
      return x(k, 0) + T(std::numbers::sqrt2 / 2) * x(k, 1) + T(std::numbers::inv_sqrt3) * x(k, 2);
    };
    const T farthest = -(along(0) * along(1) * along(2));  // the points have xi eta zeta < 0
    const T decisive = select(abs(handedness) > T(alike), handedness, farthest);
    return select(decisive < T(0), T(-1), T(1));
  }

  /// The deformation at each point.
  template <class T>
  struct Deformation {
    HourglassModes<T> q;  ///< hourglass displacements, m
    std::array<Tensor<T>, 4> H;
    std::array<VolumeChange<T>, 4> change;
  };

  template <class Hourglass, class T>
  static Deformation<T> deformation(const ElementMotion<T>& motion, const Element<T>& element) {
    const Tensor<T> H = OnePoint::mean_gradient(motion.u, element);
    // Initialised in place: assignments would copy from temporaries.
    Deformation<T> now{.q = OnePoint::hourglass_displacements(motion.u, H, element),
                       .H = point_gradients(H, now.q, element),
                       .change = volume_changes(now.H)};
    return now;
  }

  /// Internal forces (N) in modes.
  template <class Hourglass, class T, class Law>
  static Modes<T> force(const Deformation<T>& now, const Element<T>& element,
                        const typename Hourglass::template Element<T>& control, NoHistory<T>& /*history*/,
                        const Law& law) {
    const T p = law.pressure(mean_dilatation(now.change));
    const T quarter = T(0.25) * element.V;
    std::array<Tensor<T>, 4> P;  // times the reference volume of a point
    for_each_stress(
        law, now.H,
        [&](std::size_t q) {
          return PointLoad<T>{quarter, now.change[q], p};
        },
        [&](std::size_t q, const Tensor<T>& VP) { P[q] = VP; });
    // The transpose of `point_gradients`.
    const Tensor<T> lower = P[0] + P[1], upper = P[2] + P[3];
    const Tensor<T> x = P[1] - P[0], y = P[2] - P[3];
    const Tensor<T> along_xi = x + y, along_eta = x - y, along_zeta = upper - lower;
    HourglassModes<T> Q;
    if constexpr (Hourglass::traits.active) Q = Hourglass::resistance(now.q, control);
    for (int i = 0; i < 3; ++i) {
      if constexpr (!Hourglass::traits.active) Q(3, i) = T(0);
      Q(0, i) = element.reach * (row_dot(along_eta, i, element, 2) + row_dot(along_zeta, i, element, 1));
      Q(1, i) = element.reach * (row_dot(along_xi, i, element, 2) + row_dot(along_zeta, i, element, 0));
      Q(2, i) = element.reach * (row_dot(along_xi, i, element, 1) + row_dot(along_eta, i, element, 0));
    }
    return OnePoint::modal_forces(transpose(lower + upper), Q, element.c, element);
  }

  /// Strain and hourglass energy (J).
  template <class Hourglass, class T, class Law>
  static ElementEnergy<T> energy(const ElementMotion<T>& motion, const Element<T>& element,
                                 const typename Hourglass::template Element<T>& control,
                                 const NoHistory<T>& /*history*/, const Law& law) {
    const Deformation<T> now = deformation<Hourglass>(motion, element);
    T W = T(0);
    for (std::size_t q = 0; q < 4; ++q) W = W + T(0.25) * at_point(law, q).isochoric_energy(now.H[q]);
    ElementEnergy<T> energy{element.V * (W + law.volumetric_energy(mean_dilatation(now.change))), T(0)};
    if constexpr (Hourglass::traits.active) energy.hourglass = hourglass_energy<Hourglass>(now.q, control);
    return energy;
  }

  template <class T>
  static T smallest_jacobian(const ElementMotion<T>& motion, const Element<T>& element) {
    const std::array<T, 4> at = dilatations(motion, element);
    return T(1) + min(min(at[0], at[1]), min(at[2], at[3]));
  }

  template <class T>
  static T dilatation(const ElementMotion<T>& motion, const Element<T>& element) {
    return mean(dilatations(motion, element));
  }

  /// An upper bound of the largest eigenvalue (N/m) of the tangent stiffness.
  template <class Hourglass, class T, class Law>
  static T stiffness_bound(const ElementMotion<T>& motion, const Element<T>& element,
                           const typename Hourglass::template Element<T>& control,
                           const NoHistory<T>& /*history*/, const Law& law) {
    const Deformation<T> now = deformation<Hourglass>(motion, element);
    const NodalVectors<T> h = OnePoint::nodal_gradients(element);
    const Matrix<T, 8, 4> gamma = OnePoint::gamma(h, element);
    std::array<T, 4> weight, dilatation;
    weight.fill(T(0.25) * element.V);
    dilatation.fill(mean_dilatation(now.change));
    const auto spatial_gradient = [&](std::size_t p) {
      return (h + gamma * fluctuation(p, element)) * inverse(identity<T>() + now.H[p]);
    };
    const T body = point_bound<true>(now.H, dilatation, weight, element.V, spatial_gradient, law);
    if constexpr (Hourglass::traits.active) return body + Hourglass::stiffness_bound(gamma, control);
    return body;
  }

  /// The gradient (1/m) at a point of a unit of each hourglass displacement.
  template <class T>
  static Matrix<T, 4, 3> fluctuation(std::size_t point, const Element<T>& element) {
    constexpr std::array<std::array<double, 3>, 4> signs{{{-1, -1, -1}, {1, 1, -1}, {1, -1, 1}, {-1, 1, 1}}};
    const T xi = T(signs[point][0]) * element.reach, eta = T(signs[point][1]) * element.reach,
            zeta = T(signs[point][2]) * element.reach;
    Matrix<T, 4, 3> G;
    for (int l = 0; l < 3; ++l) {
      G(0, l) = eta * element.h(2, l) + zeta * element.h(1, l);
      G(1, l) = xi * element.h(2, l) + zeta * element.h(0, l);
      G(2, l) = xi * element.h(1, l) + eta * element.h(0, l);
      G(3, l) = T(0);
    }
    return G;
  }

 private:
  /// Axes count as alike below this handedness, which is above the rounding of single-precision coordinates.
  static constexpr double alike = 1e-6;

  template <class T>
  static std::array<VolumeChange<T>, 4> volume_changes(const std::array<Tensor<T>, 4>& H) {
    return {volume_change(H[0]), volume_change(H[1]), volume_change(H[2]), volume_change(H[3])};
  }

  template <class T>
  static T mean(const std::array<T, 4>& at) {
    return T(0.25) * ((at[0] + at[1]) + (at[2] + at[3]));
  }

  /// The mean of J - 1.
  template <class T>
  static T mean_dilatation(const std::array<VolumeChange<T>, 4>& change) {
    return mean<T>(
        {change[0].J_minus_one, change[1].J_minus_one, change[2].J_minus_one, change[3].J_minus_one});
  }

  /// J - 1 at the points.
  template <class T>
  static std::array<T, 4> dilatations(const ElementMotion<T>& motion, const Element<T>& element) {
    const Tensor<T> H = OnePoint::mean_gradient(motion.u, element);
    const auto at = point_gradients(H, OnePoint::hourglass_displacements(motion.u, H, element), element);
    return {jacobian_minus_one(at[0]), jacobian_minus_one(at[1]), jacobian_minus_one(at[2]),
            jacobian_minus_one(at[3])};
  }

  /// Displacement gradients at the four points: H + xi A_xi + eta A_eta + zeta A_zeta, where the term of an
  /// axis is due to the two modes that vary along it.
  template <class T>
  static std::array<Tensor<T>, 4> point_gradients(const Tensor<T>& H, const HourglassModes<T>& q,
                                                  const Element<T>& element) {
    const auto modes = element.reach * q;
    const auto along = [&](int i, int l, int b, int j, int c, int k) {
      return modes(b, i) * element.h(j, l) + modes(c, i) * element.h(k, l);
    };
    std::array<Tensor<T>, 4> at;
    for (int i = 0; i < 3; ++i) {
      for (int l = 0; l < 3; ++l) {
        const T xi = along(i, l, 2, 1, 1, 2), eta = along(i, l, 2, 0, 0, 2), zeta = along(i, l, 1, 0, 0, 1);
        const T sum = xi + eta, difference = xi - eta;
        const T lower = H(i, l) - zeta, upper = H(i, l) + zeta;
        at[0](i, l) = lower - sum;
        at[1](i, l) = lower + sum;
        at[2](i, l) = upper + difference;
        at[3](i, l) = upper - difference;
      }
    }
    return at;
  }

  /// sum_j P_ij dxi_k/dX_j.
  template <class T>
  static T row_dot(const Tensor<T>& P, int i, const Element<T>& element, int k) {
    return P(i, 0) * element.h(k, 0) + P(i, 1) * element.h(k, 1) + P(i, 2) * element.h(k, 2);
  }
};

}  // namespace sandglass
