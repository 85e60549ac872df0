#pragma once

#include "element/hourglass_fluctuation.hpp"
#include "element/hourglass_matrix.hpp"

namespace sandglass {

/// The stabilization matrix of Liu, Ong and Uras 1985: the stiffness of the mean-dilatation element minus
/// that of one point, both undeformed. The difference vanishes for linear fields, hence is a matrix between
/// hourglass displacements; the pressure, one for the element, is the same in both, so that the matrix
/// depends only on the law's isochoric stiffness. At small displacements one point with this matrix is
/// identical to the mean-dilatation element, for any shape.
struct StabilizationMatrix {
  /// K_aibj = integral of (grad w_a)_k C_ikjl (grad w_b)_l (N/m), with C the undeformed isochoric tangent.
  template <class Law>
  static HourglassMatrix<double> matrix(const NodalVectors<double>& X, const Law& law) {
    const HourglassFluctuation fluctuation = hourglass_fluctuation(X);
    const Matrix<double, 9, 9> C = undeformed_isochoric_tangent(law);
    Matrix<double, 12, 12> K{};
    for (std::size_t p = 0; p < 8; ++p) {
      Matrix<double, 9, 12> gradient{};  // of the displacement that each q_ai makes
      for (int a = 0; a < 4; ++a) {
        for (int i = 0; i < 3; ++i) {
          for (int k = 0; k < 3; ++k) gradient(3 * i + k, 3 * a + i) = fluctuation.gradient[p](a, k);
        }
      }
      K += fluctuation.weight[p] * (transpose(gradient) * (C * gradient));
    }
    return symmetric_part(K);
  }
};

}  // namespace sandglass
