#pragma once

#include <cstddef>
#include <memory>
#include <span>
#include <vector>

namespace sandglass {

/// Solves A x = b for a dense, symmetric, positive semidefinite matrix by Eigen's LDL^T factorisation with
/// pivoting. Rows with a diagonal entry below `smallest_diagonal` of the largest are left out, and x is zero
/// there. The others are scaled to a diagonal of 1; those with a pivot below `smallest_pivot` are linear
/// combinations of the others up to roundoff and are left out, too. The bits depend only on the numbers: one
/// thread computes them, in memory with a fixed alignment.
class SemidefiniteSolver {
 public:
  static constexpr double smallest_diagonal = 1e-8;
  static constexpr double smallest_pivot = 1e-6;

  explicit SemidefiniteSolver(std::size_t size);
  SemidefiniteSolver(const SemidefiniteSolver&) = delete;
  SemidefiniteSolver& operator=(const SemidefiniteSolver&) = delete;
  ~SemidefiniteSolver();

  /// Factorises A, size x size; its entries must be finite.
  void factorise(const std::vector<double>& A);

  /// x with A x = b in the rows that are not left out. Allocates nothing.
  void solve(std::span<const double> b, std::span<double> x);

 private:
  struct Factor;
  std::unique_ptr<Factor> factor_;
};

}  // namespace sandglass
