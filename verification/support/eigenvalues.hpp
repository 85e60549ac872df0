#pragma once

#include <array>
#include <utility>
#include <vector>

#include "math/matrix.hpp"

namespace sandglass::verification {

/// Eigenvalues of a symmetric matrix given by rows, in ascending order.
std::vector<double> symmetric_eigenvalues(const double* entries, int size);

/// The same with eigenvectors of length one.
std::vector<std::pair<double, std::vector<double>>> symmetric_eigenpairs(const double* entries, int size);

/// The largest absolute value of the (possibly complex) eigenvalues of any square matrix.
double largest_eigenvalue_magnitude(const double* entries, int size);

template <int N>
std::vector<double> eigenvalues(const Matrix<double, N, N>& symmetric) {
  return symmetric_eigenvalues(symmetric.entries.data(), N);
}

}  // namespace sandglass::verification
