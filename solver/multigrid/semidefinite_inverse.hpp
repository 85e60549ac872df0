#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <vector>

namespace sandglass {

/// The inverse of a dense, symmetric, positive semidefinite matrix A by the sweep operator (Goodnight 1979),
/// which needs no pivoting. A row is omitted, with x zero there, if its diagonal entry is below 1e-8 of the
/// largest or if it depends on earlier rows up to 1e-6 of its diagonal entry.
class SemidefiniteInverse {
 public:
  explicit SemidefiniteInverse(std::size_t size);

  /// Takes A, size x size by rows; its entries must be finite.
  void invert(const std::vector<double>& A);

  /// x = A^-1 b. Allocates nothing.
  void solve(std::span<const double> b, std::span<double> x) const;

 private:
  /// Pivots taken at a time.
  static constexpr std::size_t panel = 8;
  /// Entries of x that are computed together, in registers.
  static constexpr std::size_t piece = 32;
  using Block = std::array<std::array<double, panel>, panel>;

  void invert_block(std::size_t first, double floor, Block& B) const;
  /// b . V_j for a row j of the panel's columns.
  double product(const std::array<double, panel>& b, const double* V_j) const {
    double sum = b[0] * V_j[0];
    for (std::size_t p = 1; p < panel; ++p) sum += b[p] * V_j[p * stride_];
    return sum;
  }
  double& entry(std::size_t row, std::size_t column) { return matrix_[row * stride_ + column]; }

  std::size_t size_;
  std::size_t stride_;          // of the rows of the matrix, whole pieces
  std::vector<double> matrix_;  // A, then its inverse; by rows
  std::vector<double> panel_;   // columns of the pivots, one after another
  std::vector<double> diagonal_;
};

}  // namespace sandglass
