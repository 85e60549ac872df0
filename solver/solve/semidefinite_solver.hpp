#pragma once

#include <cstddef>
#include <memory>
#include <span>
#include <vector>

namespace sandglass {

/// Solves A x = b for a dense, symmetric, positive semidefinite matrix by Eigen's Cholesky factorisation. A
/// row whose diagonal entry is below 1e-8 of the largest is left out, and x is zero there. The others are
/// scaled to a diagonal of 1, to which `shift` is added: it keeps the factorisation from breaking down where
/// rows depend on each other, and changes x where A has eigenvalues of its size. The bits depend on the
/// numbers alone: one thread computes them, in memory that is always aligned alike.
class SemidefiniteSolver {
 public:
  /// Far below the softest motions of a body on a coarse grid, far above the roundoff of a factorisation.
  static constexpr double shift = 1e-10;

  explicit SemidefiniteSolver(std::size_t size);
  SemidefiniteSolver(const SemidefiniteSolver&) = delete;
  SemidefiniteSolver& operator=(const SemidefiniteSolver&) = delete;
  ~SemidefiniteSolver();

  /// Takes A, size x size; its entries must be finite.
  void factorise(const std::vector<double>& A);

  /// x = A^-1 b; b must be in the range of A. Allocates nothing.
  void solve(std::span<const double> b, std::span<double> x);

 private:
  struct Factor;
  std::unique_ptr<Factor> factor_;
};

}  // namespace sandglass
