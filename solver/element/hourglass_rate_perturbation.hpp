#pragma once

#include "element/hourglass_perturbation.hpp"
#include "element/one_point.hpp"

namespace sandglass {

/// R v for the rotation of a spin: Cayley's form of the rotation vector 2 b, exact in length (Hughes and
/// Winget 1980).
template <class T>
Triple<T> rotated(const Triple<T>& v, const Triple<T>& b, const T& scale) {
  const Triple<T> turn = cross(b, v);
  return v + scale * (turn + cross(b, turn));
}

/// Perturbation hourglass control of Flanagan and Belytschko 1981 as Updated Lagrangian codes run it:
/// hourglass resistances are integrated from hourglass velocities, turn with the element's spin, and their
/// stiffness follows the current geometry.
struct RatePerturbationControl : PerturbationStiffness {
  template <class T>
  struct Element {
    T modulus;  ///< kappa (lambda + 2 mu), Pa
  };

  /// Hourglass resistances, N.
  template <class T>
  struct History {
    HourglassModes<T> Q;
  };

  template <class Law>
  static Element<double> precompute(const NodalVectors<double>& /*X*/, const Law& law,
                                    const HourglassSettings& settings) {
    return {modulus(law, settings)};
  }

  /// Q <- R Q + k gamma^T v dt: what was there turns with the spin of L, the rate is added.
  template <class T>
  static HourglassModes<T> resistance(const HourglassModes<T>& rate, const Tensor<T>& L,
                                      const OnePoint::Element<T>& current, const Element<T>& element,
                                      History<T>& history) {
    const T quarter(0.25);  // half of the spin vector, itself half of these differences
    const Triple<T> b{
        {quarter * (L(2, 1) - L(1, 2)), quarter * (L(0, 2) - L(2, 0)), quarter * (L(1, 0) - L(0, 1))}};
    const T scale = T(2) / (T(1) + double_dot(b, b));
    const T k = stiffness(current, element);
    for (int a = 0; a < 4; ++a) {
      const Triple<T> turned =
          rotated(Triple<T>{{history.Q(a, 0), history.Q(a, 1), history.Q(a, 2)}}, b, scale);
      for (int i = 0; i < 3; ++i) history.Q(a, i) = turned(i, 0) + k * rate(a, i);
    }
    return history.Q;
  }

  /// |Q|^2 / (2 k) in J: what the resistances would give back at the current stiffness.
  template <class T>
  static T energy(const OnePoint::Element<T>& current, const Element<T>& element, const History<T>& history) {
    return T(0.5) * double_dot(history.Q, history.Q) / stiffness(current, element);
  }

  /// k lambda_max(gamma^T gamma) in N/m.
  template <class T>
  static T stiffness_bound(const Matrix<T, 8, 4>& gamma, const OnePoint::Element<T>& current,
                           const Element<T>& element) {
    return stiffness(current, element) * shape_vector_bound(gamma);
  }

 private:
  /// k = kappa K_max / 8 of the current configuration, N/m (eqs 6-8 and 12); sum_I h_I^2 is 8 times that of
  /// the modes.
  template <class T>
  static T stiffness(const OnePoint::Element<T>& current, const Element<T>& element) {
    return element.modulus * current.V * double_dot(current.h, current.h);
  }
};

}  // namespace sandglass
