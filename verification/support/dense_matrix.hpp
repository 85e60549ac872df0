#pragma once

#include <array>
#include <functional>
#include <span>
#include <vector>

#include "math/dense.hpp"
#include "math/matrix.hpp"

namespace sandglass::verification {

/// Eigenvalues of a symmetric matrix given by rows, in ascending order.
inline std::vector<double> symmetric_eigenvalues(std::span<const double> entries) {
  return symmetric_eigenpairs(entries).values;
}

/// The largest absolute value of the (possibly complex) eigenvalues of any square matrix.
double largest_eigenvalue_magnitude(const double* entries, int size);

/// The solution x of A x = b as a function of b; A is given by rows and is factored once.
std::function<std::vector<double>(const std::vector<double>&)> factored(const double* entries, int size);

template <int N>
std::vector<double> eigenvalues(const Matrix<double, N, N>& symmetric) {
  return symmetric_eigenvalues(symmetric.entries);
}

}  // namespace sandglass::verification
