#pragma once

#include "element/element_motion.hpp"
#include "element/hourglass_fluctuation.hpp"
#include "element/hourglass_settings.hpp"
#include "math/symmetric_matrix.hpp"

namespace sandglass {

/// A bound of the eigenvalues of a matrix between hourglass displacements: the largest sum over a row of
/// blocks of the largest singular values of its 3 x 3 blocks. Unlike sums of entries it does not change when
/// the axes are rotated, so that the stable step of a body does not depend on its orientation.
template <class T>
T block_row_sum_bound(const Matrix<T, 12, 12>& A) {
  Matrix<T, 4, 4> norms;
  for (int a = 0; a < 4; ++a) {
    for (int b = 0; b < 4; ++b) {
      Tensor<T> block;
      for (int i = 0; i < 3; ++i) {
        for (int j = 0; j < 3; ++j) block(i, j) = A(3 * a + i, 3 * b + j);
      }
      norms(a, b) = sqrt(largest_eigenvalue_bound(transpose(block) * block));
    }
  }
  return row_sum_bound(norms);
}

/// The stabilization matrix of Liu, Ong and Uras 1985: the stiffness of the mean-dilatation element minus
/// that of one point, both undeformed. The difference vanishes for linear fields, so it is a matrix between
/// hourglass displacements. The element's single pressure is the same in both, so the matrix depends only on
/// the law's isochoric stiffness. At small displacements one point with this matrix is identical to the
/// mean-dilatation element, for any shape. The control follows the mean deformation.
struct StabilizationMatrixControl {
  static constexpr HourglassTraits traits{.follows_deformation = true, .grows_with_deformation = true};

  template <class T>
  struct Element {
    SymmetricMatrix<T, 12> K;  ///< N/m; row and column 3 a + i belong to q_ai
  };
  template <class T>
  using History = NoHistory<T>;

  /// K_aibj = integral of (grad w_a)_k C_ikjl (grad w_b)_l (N/m), with C the undeformed isochoric tangent.
  template <class Law>
  static Element<double> precompute(const NodalVectors<double>& X, const Law& law,
                                    const HourglassSettings& /*settings*/) {
    const HourglassFluctuation fluctuation = hourglass_fluctuation(X);
    const Matrix<double, 9, 9> C = undeformed_isochoric_tangent(law);
    Matrix<double, 12, 12> K{};
    for (std::size_t p = 0; p < 8; ++p) {
      Matrix<double, 9, 12> gradient{};  // of the displacement caused by each q_ai
      for (int a = 0; a < 4; ++a) {
        for (int i = 0; i < 3; ++i) {
          for (int k = 0; k < 3; ++k) gradient(3 * i + k, 3 * a + i) = fluctuation.gradient[p](a, k);
        }
      }
      K += fluctuation.weight[p] * (transpose(gradient) * (C * gradient));
    }
    return {symmetric_part(K)};
  }

  /// K r, in N.
  template <class T>
  static HourglassModes<T> resistance(const HourglassModes<T>& r, const Element<T>& element) {
    HourglassModes<T> Q;
    const auto flat = [&](int n) { return r.entries[static_cast<std::size_t>(n)]; };
    for (int row = 0; row < 12; ++row) {
      Q.entries[static_cast<std::size_t>(row)] = row_product(element.K, row, flat);
    }
    return Q;
  }

  /// With G = gamma (x) I, G K G^T has the eigenvalues of K G^T G (N/m), bounded by `block_row_sum_bound`.
  template <class T>
  static T stiffness_bound(const Matrix<T, 8, 4>& gamma, const Element<T>& element) {
    const Matrix<T, 4, 4> product = transpose(gamma) * gamma;
    Matrix<T, 12, 12> KGG;
    for (int row = 0; row < 12; ++row) {
      for (int b = 0; b < 4; ++b) {
        for (int i = 0; i < 3; ++i) {
          T sum = element.K(row, i) * product(0, b);
          for (int a = 1; a < 4; ++a) sum = sum + element.K(row, 3 * a + i) * product(a, b);
          KGG(row, 3 * b + i) = sum;
        }
      }
    }
    return block_row_sum_bound(KGG);
  }
};

}  // namespace sandglass
