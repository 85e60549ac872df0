#pragma once

#include "element/element_motion.hpp"
#include "element/hourglass_settings.hpp"
#include "math/symmetric_matrix.hpp"

namespace sandglass {

/// A constant matrix between the twelve hourglass displacements: row and column 3 a + i belong to q_ai.
template <class T>
using HourglassMatrix = SymmetricMatrix<T, 12>;

/// Hourglass control by a constant matrix K (N/m) that `Source::matrix(X, law)` makes at set-up: q K q / 2 at
/// small displacements. It follows the mean deformation.
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

  /// K r, in N.
  template <class T>
  static HourglassModes<T> resistance(const HourglassModes<T>& r, const Element<T>& element) {
    return {(element.K * Matrix<T, 12, 1>{r.entries}).entries};
  }

  /// r K r / 2, in J.
  template <class T>
  static T energy(const HourglassModes<T>& r, const Element<T>& element) {
    return T(0.5) * double_dot(r, resistance(r, element));
  }

  /// With G = gamma (x) I, G K G^T has the eigenvalues of K G^T G, N/m; they are bounded by the largest sum
  /// of the norms of its blocks of 3 by 3 in a row. Norms of blocks do not depend on the axes, sums of
  /// entries would.
  template <class T>
  static T stiffness_bound(const Matrix<T, 8, 4>& gamma, const Element<T>& element) {
    const Matrix<T, 4, 4> product = transpose(gamma) * gamma;
    T largest = T(0);
    for (int a = 0; a < 4; ++a) {
      T row = T(0);
      for (int b = 0; b < 4; ++b) {
        Tensor<T> block = product(0, b) * modes_block(element, a, 0);
        for (int c = 1; c < 4; ++c) block += product(c, b) * modes_block(element, a, c);
        row = row + sqrt(largest_eigenvalue_bound(transpose(block) * block));
      }
      largest = max(largest, row);
    }
    return largest;
  }

 private:
  /// K between the modes a and b.
  template <class T>
  static Tensor<T> modes_block(const Element<T>& element, int a, int b) {
    Tensor<T> block;
    for (int i = 0; i < 3; ++i) {
      for (int j = 0; j < 3; ++j) block(i, j) = element.K(3 * a + i, 3 * b + j);
    }
    return block;
  }
};

}  // namespace sandglass
