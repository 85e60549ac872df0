#pragma once

#include "element/gram_bound.hpp"
#include "element/updated_one_point.hpp"

namespace sandglass {

/// R v for the rotation of a spin: Cayley's form of the rotation vector 2 b, exact in length (Hughes and
/// Winget 1980).
template <class T>
Triple<T> rotated(const Triple<T>& v, const Triple<T>& b, const T& scale) {
  const Triple<T> turn = cross(b, v);
  return v + scale * (turn + cross(b, turn));
}

/// Hourglass control as in Updated Lagrangian codes: hourglass resistances are integrated from hourglass
/// velocities, rotate with the element's spin, and their stiffness follows the current geometry. A `Form`
/// defines the stiffness: Element<T> and precompute(X, law, settings) for its moduli, and stiffness(x,
/// current, moduli), an object of the current configuration with
///   resistance(q)  the resistances (N) to hourglass displacements q (m): linear, symmetric, positive,
///   energy(Q)      the complementary energy (J) of resistances Q (N),
///   bound()        an upper bound (N/m) of the largest eigenvalue of q -> Q.
template <class Form>
struct RateHourglassControl : Form {
  template <class T>
  using Element = typename Form::template Element<T>;

  /// Hourglass resistances, N.
  template <class T>
  struct History {
    HourglassModes<T> Q;
  };

  /// Q <- R Q + K gamma^T v dt (N): the resistances rotate with the spin of L, and those to the hourglass
  /// velocities of the step are added (eq. 3 and eq. 4 in the current configuration, without the factors
  /// 1/sqrt 8).
  template <class T>
  static HourglassModes<T> resistance(const UpdatedOnePoint::Deformation<T>& now, const Element<T>& element,
                                      History<T>& history) {
    const Tensor<T>& L = now.L;
    const T quarter(0.25);  // half of the spin vector, itself half of these differences
    const Triple<T> b{
        {quarter * (L(2, 1) - L(1, 2)), quarter * (L(0, 2) - L(2, 0)), quarter * (L(1, 0) - L(0, 1))}};
    const T scale = T(2) / (T(1) + double_dot(b, b));
    const HourglassModes<T> added = Form::stiffness(now.x, now.current, element).resistance(now.rate);
    for (int a = 0; a < 4; ++a) {
      const Triple<T> turned =
          rotated(Triple<T>{{history.Q(a, 0), history.Q(a, 1), history.Q(a, 2)}}, b, scale);
      for (int i = 0; i < 3; ++i) history.Q(a, i) = turned(i, 0) + added(a, i);
    }
    return history.Q;
  }

  /// The energy (J) that the resistances would release at the current stiffness.
  template <class T>
  static T energy(const UpdatedOnePoint::Deformation<T>& now, const Element<T>& element,
                  const History<T>& history) {
    return Form::stiffness(now.x, now.current, element).energy(history.Q);
  }

  /// The body's bound, plus lambda_max(K) lambda_max(gamma^T gamma), plus the geometric stiffness of the
  /// present resistances: with velocities v, forces gamma Q change by -h (v^T gamma Q), and by gamma W Q as Q
  /// rotates with the spin, where |W Q_a| <= |L| / sqrt(2) |Q_a| and |L|^2 <= lambda_max(h^T h) |v|^2. The
  /// sum is safe whatever the angles between their modes. In N/m.
  template <class T>
  static T stiffness_bound(const T& body, const Matrix<T, 8, 4>& gamma,
                           const UpdatedOnePoint::Deformation<T>& now, const Element<T>& element,
                           const History<T>& history) {
    const T shape = shape_vector_bound(gamma);
    const NodalVectors<T> h = OnePoint::nodal_gradients(now.current);
    const NodalVectors<T> gamma_Q = gamma * history.Q;
    const T gg = largest_eigenvalue_bound(transpose(h) * h);
    const T geometric = sqrt(gg * largest_eigenvalue_bound(transpose(gamma_Q) * gamma_Q)) +
                        sqrt(T(0.5) * gg * shape * double_dot(history.Q, history.Q));
    return body + Form::stiffness(now.x, now.current, element).bound() * shape + geometric;
  }
};

}  // namespace sandglass
