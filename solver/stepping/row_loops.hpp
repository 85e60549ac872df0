#pragma once

#include <algorithm>
#include <span>
#include <vector>

#include "base/parallel.hpp"
#include "math/rows.hpp"

/// Loops over all rows as one run of numbers, in blocks of fixed size: a block's sum does not depend on who
/// computes it, so that the same bits come from any number of threads.
namespace sandglass {

inline constexpr std::size_t numbers_per_block = 4096;

inline std::size_t blocks_of(std::size_t numbers) {
  return (numbers + numbers_per_block - 1) / numbers_per_block;
}

/// Calls body(first, last) for the blocks of n numbers.
template <class Function>
void for_each_block(std::size_t n, int threads, const Function& body) {
  in_parallel(blocks_of(n), threads, [&](std::size_t b) {
    body(b * numbers_per_block, std::min(n, (b + 1) * numbers_per_block));
  });
}

/// The sum over blocks, in order, of what function(first, last) returns for each.
template <class Sum, class Function>
Sum sum_over_blocks(std::size_t n, int threads, const Function& function) {
  std::vector<Sum> partial(blocks_of(n));
  in_parallel(partial.size(), threads, [&](std::size_t b) {
    partial[b] = function(b * numbers_per_block, std::min(n, (b + 1) * numbers_per_block));
  });
  Sum sum{};
  for (const Sum& part : partial) sum += part;
  return sum;
}

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

}  // namespace sandglass
