#pragma once

#include <array>
#include <functional>
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

/// The solution x of A x = b as a function of b; A is given by rows and is factored once.
std::function<std::vector<double>(const std::vector<double>&)> factored(const double* entries, int size);

/// exp(A) of a square matrix, both by rows.
std::vector<double> exponential(const double* entries, int size);

template <int N>
std::vector<double> eigenvalues(const Matrix<double, N, N>& symmetric) {
  return symmetric_eigenvalues(symmetric.entries.data(), N);
}

}  // namespace sandglass::verification
