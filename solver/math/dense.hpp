#pragma once

#include <span>
#include <vector>

/// Small dense matrices, given by rows. Only dense.cpp includes Eigen, which takes long to compile.
namespace sandglass {

/// The eigenvalues of a symmetric matrix in ascending order, and their eigenvectors, which are orthonormal.
struct Eigenpairs {
  std::vector<double> values;
  std::vector<std::vector<double>> vectors;
};

/// Those of n rows of n entries; only the lower triangle is used.
Eigenpairs symmetric_eigenpairs(std::span<const double> entries);

/// Those of the tridiagonal matrix with n numbers on the diagonal, and n - 1 beside it.
Eigenpairs tridiagonal_eigenpairs(std::span<const double> diagonal, std::span<const double> beside);

/// The solution x of A x = b for a symmetric, positive definite A of b.size() rows, by Cholesky's
/// factorisation; only the lower triangle is used.
std::vector<double> solve_positive_definite(std::span<const double> entries, std::vector<double> b);

}  // namespace sandglass
