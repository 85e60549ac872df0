#pragma once

#include "element/element_motion.hpp"
#include "element/hourglass_response.hpp"
#include "element/hourglass_settings.hpp"
#include "math/strain.hpp"
#include "math/symmetric_matrix.hpp"

namespace sandglass {

/// A constant matrix between the twelve hourglass displacements: row and column 3 a + i belong to q_ai.
template <class T>
using HourglassMatrix = SymmetricMatrix<T, 12>;

/// Hourglass control by a constant matrix K (N/m) that `Source::matrix(X, law)` makes at set-up. At small
/// displacements it is q K q / 2. In the large K acts on r_a = F^T q_a: the fluctuation's part of Green's
/// strain that is linear in q is the symmetric part of F^T grad w = sum_a r_a (x) grad w_a, so that the
/// matrix of a quadratic energy of strains keeps its meaning at any deformation and rotation, without a polar
/// decomposition. The energy E = r K r / 2 gives both Q_a = F (K r)_a and the stress sum_a q_a (x) (K r)_a.
template <class Source>
struct HourglassMatrixControl {
  static constexpr bool active = true;
  static constexpr bool takes_kappa = false;
  static constexpr bool follows_deformation = true;

  template <class T>
  struct Element {
    HourglassMatrix<T> K;  ///< N/m
  };
  template <class T>
  using History = NoHistory<T>;

  template <class Law>
  static Element<double> precompute(const NodalVectors<double>& X, const Law& law,
                                    const HourglassSettings& /*settings*/) {
    return {Source::matrix(X, law)};
  }

  template <class T>
  static HourglassResponse<T> response(const HourglassModes<T>& q, const Tensor<T>& H,
                                       const Element<T>& element) {
    const HourglassModes<T> s = conjugate(pulled_back(q, H), element);
    return {s + s * transpose(H), transpose(s) * q};
  }

  /// r K r / 2, in J.
  template <class T>
  static T energy(const HourglassModes<T>& q, const Tensor<T>& H, const Element<T>& element) {
    const HourglassModes<T> r = pulled_back(q, H);
    return T(0.5) * double_dot(r, conjugate(r, element));
  }

  /// A displacement v of the nodes changes r by A v and its second variation is
  ///   v A^T K A v + 2 sum_a s_a . (h^T v)(v^T gamma_a),  s = K r.
  /// K A A^T bounds the first term and, in every component of v alike, the Frobenius norm of
  /// h s^T gamma^T + its transpose the second.
  template <class T>
  static T stiffness_bound(const Matrix<T, 8, 4>& gamma, const NodalVectors<T>& h, const HourglassModes<T>& q,
                           const Tensor<T>& H, const Element<T>& element) {
    const Tensor<T> F = identity<T>() + H;
    Matrix<T, 12, 24> A;
    for (int a = 0; a < 4; ++a) {
      for (int j = 0; j < 3; ++j) {
        for (int I = 0; I < 8; ++I) {
          for (int i = 0; i < 3; ++i) A(3 * a + j, 3 * I + i) = gamma(I, a) * F(i, j) + h(I, j) * q(a, i);
        }
      }
    }
    const HourglassModes<T> s = conjugate(pulled_back(q, H), element);
    const Matrix<T, 8, 8> hs = h * transpose(gamma * s);
    const Matrix<T, 8, 8> geometric = hs + transpose(hs);
    return row_sum_bound(element.K * (A * transpose(A))) + sqrt(double_dot(geometric, geometric));
  }

 private:
  /// r_a = F^T q_a.
  template <class T>
  static HourglassModes<T> pulled_back(const HourglassModes<T>& q, const Tensor<T>& H) {
    return q + q * H;
  }

  /// K r.
  template <class T>
  static HourglassModes<T> conjugate(const HourglassModes<T>& r, const Element<T>& element) {
    return {(element.K * Matrix<T, 12, 1>{r.entries}).entries};
  }
};

}  // namespace sandglass
