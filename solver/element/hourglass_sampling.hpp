#pragma once

#include "element/element_motion.hpp"
#include "element/hourglass_settings.hpp"
#include "element/one_point.hpp"
#include "math/symmetric_matrix.hpp"

/// Energy sampling in its cheapest form: the shear energy that one point misses, for each mode, on the
/// parallelepiped of the mean gradient, with constant stiffnesses. |q| does not change as an element rotates.
namespace sandglass {

/// Stiffnesses (N/m) of the four hourglass modes to q = gamma^T u, of an element with the one-point geometry
/// `body`. The amplitude of a mode is q/8, and the mean gradients h of the first three modes are dxi_k/dX
/// over 8, so that the integral of 10/9 mu |grad w_a|^2 is 10/9 mu V (|h_j|^2 + |h_k|^2) / 3 for w = xi_j
/// xi_k and 10/9 mu V sum |h_k|^2 / 9 for the product of all three. For 10/9 see EnergySamplingControl.
template <class T, class Geometry, class Law>
std::array<T, 4> sampled_stiffness(const Geometry& body, const Law& law) {
  std::array<T, 3> square;
  for (int k = 0; k < 3; ++k) {
    square[static_cast<std::size_t>(k)] =
        body.h(k, 0) * body.h(k, 0) + body.h(k, 1) * body.h(k, 1) + body.h(k, 2) * body.h(k, 2);
  }
  const T third = T(10.0 / 27.0 * law.shear_modulus()) * body.V;
  return {third * (square[1] + square[2]), third * (square[0] + square[2]), third * (square[0] + square[1]),
          T(1.0 / 3.0) * third * (square[0] + square[1] + square[2])};
}

/// `precompute` for controls whose constants follow from the geometry of one point.
template <class Control>
struct FromGeometry {
  template <class Law>
  static auto precompute(const NodalVectors<double>& X, const Law& law, const HourglassSettings& settings) {
    return Control::template constants<double>(OnePoint::precompute(X), law, settings);
  }
};

/// Hourglass control without a parameter, at the cost of the perturbation control.
struct ModalSamplingControl : FromGeometry<ModalSamplingControl> {
  static constexpr HourglassTraits traits{};

  template <class T>
  struct Element {
    std::array<T, 4> k;  ///< stiffness of each mode, N/m
  };
  template <class T>
  using History = NoHistory<T>;

  /// From the element's geometry, for any number type.
  template <class T, class Geometry, class Law>
  static Element<T> constants(const Geometry& body, const Law& law, const HourglassSettings& /*settings*/) {
    return {sampled_stiffness<T>(body, law)};
  }

  /// Hourglass resistances Q_a = k_a q_a (N).
  template <class T>
  static HourglassModes<T> resistance(const HourglassModes<T>& q, const Element<T>& element) {
    HourglassModes<T> Q;
    for (int a = 0; a < 4; ++a) {
      for (int i = 0; i < 3; ++i) Q(a, i) = element.k[static_cast<std::size_t>(a)] * q(a, i);
    }
    return Q;
  }

  /// sum_a k_a gamma_a gamma_a^T has the eigenvalues of K gamma^T gamma, N/m.
  template <class T>
  static T stiffness_bound(const Matrix<T, 8, 4>& gamma, const Element<T>& element) {
    Matrix<T, 4, 4> products = transpose(gamma) * gamma;
    for (int a = 0; a < 4; ++a) {
      for (int b = 0; b < 4; ++b) products(a, b) = element.k[static_cast<std::size_t>(a)] * products(a, b);
    }
    return row_sum_bound(products);
  }
};

/// The same for the mode xi eta zeta only, for an element whose points resolve the other three.
struct LastModeControl : FromGeometry<LastModeControl> {
  static constexpr HourglassTraits traits{};

  template <class T>
  struct Element {
    T k;  ///< N/m
  };
  template <class T>
  using History = NoHistory<T>;

  /// From the element's geometry, for any number type.
  template <class T, class Geometry, class Law>
  static Element<T> constants(const Geometry& body, const Law& law, const HourglassSettings& /*settings*/) {
    return {sampled_stiffness<T>(body, law)[3]};
  }

  /// Resistances (N) to the hourglass displacements q (m): k q in the last mode.
  template <class T>
  static HourglassModes<T> resistance(const HourglassModes<T>& q, const Element<T>& element) {
    HourglassModes<T> Q;
    for (auto& entry : Q.entries) entry = T(0);
    for (int i = 0; i < 3; ++i) Q(3, i) = element.k * q(3, i);
    return Q;
  }

  /// k/2 |q_4|^2, in J.
  template <class T>
  static T energy(const HourglassModes<T>& q, const Element<T>& element) {
    return T(0.5) * element.k * (q(3, 0) * q(3, 0) + q(3, 1) * q(3, 1) + q(3, 2) * q(3, 2));
  }

  /// k |gamma_4|^2 in N/m.
  template <class T>
  static T stiffness_bound(const Matrix<T, 8, 4>& gamma, const Element<T>& element) {
    T square = T(0);
    for (int I = 0; I < 8; ++I) square = square + gamma(I, 3) * gamma(I, 3);
    return element.k * square;
  }
};

}  // namespace sandglass
