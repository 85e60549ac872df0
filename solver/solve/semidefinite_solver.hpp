#pragma once

#include <cstddef>
#include <memory>
#include <span>
#include <vector>

namespace sandglass {

/// Solves A x = b for a dense, symmetric, positive semidefinite matrix by Eigen's LDL^T factorisation with
/// pivoting. A row whose diagonal entry is below `smallest_diagonal` of the largest is left out, and x is zero
/// there. The others are scaled to a diagonal of 1, and those whose pivot is below `smallest_pivot` depend on
/// the others up to roundoff: they are left out too. The bits depend on the numbers alone: one thread computes
/// them, in memory that is always aligned alike.
class SemidefiniteSolver {
 public:
  static constexpr double smallest_diagonal = 1e-8;
  static constexpr double smallest_pivot = 1e-6;

  explicit SemidefiniteSolver(std::size_t size);
  SemidefiniteSolver(const SemidefiniteSolver&) = delete;
  SemidefiniteSolver& operator=(const SemidefiniteSolver&) = delete;
  ~SemidefiniteSolver();

  /// Takes A, size x size; its entries must be finite.
  void factorise(const std::vector<double>& A);

  /// x with A x = b in the rows that are not left out. Allocates nothing.
  void solve(std::span<const double> b, std::span<double> x);

 private:
  struct Factor;
  std::unique_ptr<Factor> factor_;
};

}  // namespace sandglass
