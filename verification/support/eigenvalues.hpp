#pragma once

#include <array>
#include <vector>

#include "math/matrix.hpp"

namespace sandglass::verification {

/// Eigenvalues of a symmetric matrix given by rows, in ascending order.
std::vector<double> symmetric_eigenvalues(const double* entries, int size);

template <int N>
std::vector<double> eigenvalues(const Matrix<double, N, N>& symmetric) {
  return symmetric_eigenvalues(symmetric.entries.data(), N);
}

}  // namespace sandglass::verification
