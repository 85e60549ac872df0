#pragma once

#include <algorithm>
#include <array>

#include "base/parallel.hpp"
#include "math/rows.hpp"

/// Loops over the numbers of all rows, in blocks whose size depends only on how many numbers there are, so
/// that sums over blocks have the same bits for any number of threads.
namespace sandglass {

inline constexpr std::size_t most_blocks = 256;

/// The numbers in a block: 512, or the multiple of it that keeps the number of blocks within `most_blocks`.
inline std::size_t block_size(std::size_t numbers) {
  constexpr std::size_t unit = 512;
  return unit * std::max<std::size_t>(1, (numbers + most_blocks * unit - 1) / (most_blocks * unit));
}

/// Calls body(first, last) for the blocks of n numbers.
template <class Function>
void for_each_block(std::size_t n, int threads, const Function& body) {
  const std::size_t size = block_size(n);
  in_parallel((n + size - 1) / size, threads,
              [&](std::size_t b) { body(b * size, std::min(n, (b + 1) * size)); });
}

/// The sum over all blocks, in order, of function(first, last).
template <class Sum, class Function>
Sum sum_over_blocks(std::size_t n, int threads, const Function& function) {
  std::array<Sum, most_blocks> partial;
  const std::size_t size = block_size(n), blocks = (n + size - 1) / size;
  in_parallel(blocks, threads,
              [&](std::size_t b) { partial[b] = function(b * size, std::min(n, (b + 1) * size)); });
  Sum sum{};
  for (std::size_t b = 0; b < blocks; ++b) sum += partial[b];
  return sum;
}

/// Sets all rows to zero.
template <class Real>
void clear(Rows<Real>& rows, int threads) {
  Real* x = numbers_of(rows);
  for_each_block(4 * rows.size(), threads,
                 [=](std::size_t first, std::size_t last) { std::fill(x + first, x + last, Real(0)); });
}

/// The sum over all rows of their scalar products.
template <class Real>
double dot(const Rows<Real>& a, const Rows<Real>& b, int threads) {
  const Real *x = numbers_of(a), *y = numbers_of(b);
  return sum_over_blocks<double>(4 * a.size(), threads, [=](std::size_t first, std::size_t last) {
    Real sum = 0;
#pragma omp simd reduction(+ : sum)
    for (std::size_t k = first; k < last; ++k) sum += x[k] * y[k];
    return static_cast<double>(sum);
  });
}

/// Rows rounded to another type of numbers.
template <class To, class From>
Rows<To> rounded_rows(const Rows<From>& rows) {
  Rows<To> to(rows.size());
  for (std::size_t row = 0; row < rows.size(); ++row) {
    for (std::size_t i = 0; i < 4; ++i) to[row][i] = static_cast<To>(rows[row][i]);
  }
  return to;
}

}  // namespace sandglass
