#include "multigrid/semidefinite_inverse.hpp"

#include <algorithm>

namespace sandglass {

SemidefiniteInverse::SemidefiniteInverse(std::size_t size)
    : size_(size),
      stride_((size + piece - 1) / piece * piece),
      matrix_(stride_ * stride_),
      panel_(panel * stride_),
      diagonal_(stride_) {}

/// Inverts the panel's own block; omitted rows become zero.
void SemidefiniteInverse::invert_block(std::size_t first, double floor, Block& B) const {
  for (std::size_t p = 0; p < panel; ++p) {
    for (std::size_t q = 0; q < panel; ++q) B[p][q] = panel_[p * stride_ + first + q];
  }
  for (std::size_t k = 0; k < panel; ++k) {
    const double pivot = B[k][k], original = diagonal_[first + k];
    const bool left_out = pivot <= 1e-6 * original || original <= floor;
    const double reciprocal = left_out ? 0.0 : 1.0 / pivot;
    const std::array<double, panel> row = B[k];
    for (std::size_t p = 0; p < panel; ++p) {
      for (std::size_t q = 0; q < panel; ++q) B[p][q] -= reciprocal * row[p] * row[q];
    }
    for (std::size_t p = 0; p < panel; ++p) B[k][p] = B[p][k] = reciprocal * row[p];
    B[k][k] = -reciprocal;
  }
  for (auto& row : B) {
    for (double& x : row) x = -x;
  }
}

/// The sweep operator on the lower triangle, several pivots at a time: with V their columns and B the inverse
/// of their block, A <- A - V B V^T elsewhere, V B in their columns and -B in their block. In the end A holds
/// its negative inverse.
void SemidefiniteInverse::invert(const std::vector<double>& A) {
  const std::size_t n = stride_;
  for (std::size_t i = 0; i < size_; ++i) {
    std::copy_n(A.begin() + static_cast<std::ptrdiff_t>(i * size_), size_, &entry(i, 0));
    std::fill(&entry(i, 0) + size_, &entry(i, 0) + n, 0.0);
  }
  std::fill(matrix_.begin() + static_cast<std::ptrdiff_t>(size_ * n), matrix_.end(), 0.0);
  for (std::size_t i = 0; i < n; ++i) diagonal_[i] = entry(i, i);
  const double floor = 1e-8 * *std::max_element(diagonal_.begin(), diagonal_.end());
  Block B;
  for (std::size_t first = 0; first < n; first += panel) {
    const double* const V = panel_.data();
    for (std::size_t p = 0; p < panel; ++p) {
      for (std::size_t j = 0; j < n; ++j) {
        panel_[p * n + j] = j <= first + p ? entry(first + p, j) : entry(j, first + p);
      }
    }
    invert_block(first, floor, B);
    for (std::size_t i = 0; i < n; ++i) {
      double* const row = &entry(i, 0);
      if (i >= first && i < first + panel) {
        const auto& b = B[i - first];
        for (std::size_t j = 0; j < first; ++j) row[j] = product(b, V + j);
        for (std::size_t q = 0; q < panel; ++q) row[first + q] = -b[q];
        continue;
      }
      std::array<double, panel> w;
      for (std::size_t p = 0; p < panel; ++p) w[p] = product(B[p], V + i);
#pragma omp simd
      for (std::size_t j = 0; j <= i; ++j) row[j] -= product(w, V + j);
      if (i >= first) std::copy(w.begin(), w.end(), row + first);
    }
  }
  for (std::size_t i = 0; i < n; ++i) {
    for (std::size_t j = 0; j <= i; ++j) entry(i, j) = entry(j, i) = -entry(i, j);
  }
}

/// A piece of x at a time, which stays in registers. The matrix is symmetric: its rows are its
/// columns.
void SemidefiniteInverse::solve(std::span<const double> b, std::span<double> x) const {
  for (std::size_t first = 0; first < stride_; first += piece) {
    std::array<double, piece> even{}, odd{};  // two chains of additions
    const double* column = matrix_.data() + first;
    for (std::size_t j = 0; j + 1 < size_; j += 2, column += 2 * stride_) {
#pragma omp simd
      for (std::size_t i = 0; i < piece; ++i) {
        even[i] += column[i] * b[j];
        odd[i] += column[stride_ + i] * b[j + 1];
      }
    }
    if (size_ % 2 == 1) {  // else no column is left
#pragma omp simd
      for (std::size_t i = 0; i < piece; ++i) even[i] += column[i] * b[size_ - 1];
    }
    const std::size_t left = std::min(piece, size_ - first);
    for (std::size_t i = 0; i < left; ++i) x[first + i] = even[i] + odd[i];
  }
}

}  // namespace sandglass
