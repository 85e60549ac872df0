#pragma once

#include <array>
#include <cstddef>

#include "math/symmetric_matrix.hpp"
#include "mesh/hexahedron.hpp"

/// Upper bounds of the largest eigenvalue of sums of stiffnesses that act on different nodes of an element.
/// The sum of their largest eigenvalues would be three times too large, since their modes differ.
namespace sandglass {

/// An upper bound of the largest eigenvalue of sum_n c_n g_n g_n^T, c_n >= 0, g_n in R^24. With A the matrix
/// of rows sqrt(c_n) g_n, A^T A and A A^T have the same largest eigenvalue; the latter is similar to the
/// matrix of entries c_m (g_n . g_m), whose eigenvalues are at most its largest absolute row sum
/// (Gershgorin). The bound is sharp if a uniform dilation strains all n equally.
template <class T, std::size_t N>
T gram_bound(const std::array<T, N>& c, const std::array<NodalVectors<T>, N>& g) {
  std::array<T, N> rows;
  rows.fill(T(0));
  for (std::size_t n = 0; n < N; ++n) {
    for (std::size_t m = 0; m <= n; ++m) {
      const T product = abs(double_dot(g[n], g[m]));
      rows[n] = rows[n] + c[m] * product;
      if (m < n) rows[m] = rows[m] + c[n] * product;
    }
  }
  T bound = rows[0];
  for (std::size_t n = 1; n < N; ++n) bound = max(bound, rows[n]);
  return bound;
}

/// An upper bound of lambda_max(gamma^T gamma): the largest sum of absolute values in a row.
template <class T>
T shape_vector_bound(const Matrix<T, 8, 4>& gamma) {
  return row_sum_bound(transpose(gamma) * gamma);
}

/// An upper bound of sum_n c_n |v^T g_n|^2 / |v|^2, c_n >= 0, for nodal vectors v: the largest absolute row
/// sum of the 8 x 8 matrix sum_n c_n g_n g_n^T, which acts on each component of v.
template <class T, std::size_t N>
T gradients_bound(const std::array<T, N>& c, const std::array<NodalVectors<T>, N>& g) {
  Matrix<T, 8, 8> sum = (c[0] * g[0]) * transpose(g[0]);
  for (std::size_t n = 1; n < N; ++n) sum += (c[n] * g[n]) * transpose(g[n]);
  return row_sum_bound(sum);
}

}  // namespace sandglass
