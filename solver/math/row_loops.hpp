#pragma once

#include <algorithm>
#include <cmath>
#include <memory>
#include <numeric>
#include <span>
#include <vector>

#include "base/parallel.hpp"
#include "base/ranks.hpp"
#include "math/rows.hpp"

/// Loops over the numbers of vectors, in blocks whose bounds depend only on the vector, so that sums over
/// blocks have the same bits for any number of threads and ranks.
namespace sandglass {

inline constexpr std::size_t most_blocks = 256;

/// The numbers in a block: 512, or the multiple of it that keeps the number of blocks within `most_blocks`.
inline std::size_t block_size(std::size_t numbers) {
  constexpr std::size_t unit = 512;
  return unit * std::max<std::size_t>(1, (numbers + most_blocks * unit - 1) / (most_blocks * unit));
}

/// The blocks of a vector, and a rank's share of them: sums are over its own blocks, everything else also
/// covers a few blocks that its neighbours own.
class Blocks {
 public:
  /// The numbers of the first and the last of some blocks.
  struct Range {
    std::size_t first = 0, last = 0;
  };

  Blocks() = default;

  /// All blocks of n numbers, by one rank.
  Blocks(std::size_t n, int threads) : threads_(threads) {
    cut(n, block_size(n));
    own_ = local_ = {0, count()};
  }

  /// The blocks of parts of a vector that end at `ends`: a rank owns the blocks of the parts `own`, and
  /// computes those of `local`.
  Blocks(std::span<const std::size_t> ends, Range own, Range local, const Team& team)
      : threads_(team.threads), ranks_(team.ranks) {
    std::vector<std::size_t> first_of_part;
    for (const std::size_t end : ends) {
      first_of_part.push_back(count());
      cut(end, block_size(ends.back()));
    }
    first_of_part.push_back(count());
    own_ = {first_of_part[own.first], first_of_part[own.last]};
    local_ = {first_of_part[local.first], first_of_part[local.last]};
  }

  std::size_t count() const { return bounds_.size() - 1; }
  const Ranks& ranks() const { return *ranks_; }

  /// The numbers of the blocks that this rank owns.
  Range own() const { return {bounds_[own_.first], bounds_[own_.last]}; }

  /// The numbers of the blocks that it computes.
  Range local() const { return {bounds_[local_.first], bounds_[local_.last]}; }

  /// Calls body(first, last) with the numbers of each block that is computed here, in parallel.
  template <class Function>
  void for_each(const Function& body) const {
    in_parallel(local_.last - local_.first, threads_, [&](std::size_t k) {
      const std::size_t b = local_.first + k;
      body(bounds_[b], bounds_[b + 1]);
    });
  }

  /// The sum over all blocks of all ranks, in order, of function(first, last).
  template <class Function>
  double sum(const Function& function) const {
    std::vector<double> partial(count());
    in_parallel(own_.last - own_.first, threads_, [&](std::size_t k) {
      const std::size_t b = own_.first + k;
      partial[b] = function(bounds_[b], bounds_[b + 1]);
    });
    ranks_->sum(partial);
    return std::accumulate(partial.begin(), partial.end(), 0.0);
  }

 private:
  /// About equal blocks of whole rows up to `end`, each of about `most` numbers.
  void cut(std::size_t end, std::size_t most) {
    const std::size_t begin = bounds_.back(), parts = (end - begin + most - 1) / most;
    for (std::size_t k = 1; k < parts; ++k) bounds_.push_back(begin + (end - begin) * k / parts / 4 * 4);
    if (parts > 0) bounds_.push_back(end);
  }

  int threads_ = 1;
  std::shared_ptr<const Ranks> ranks_ = std::make_shared<const Ranks>();
  std::vector<std::size_t> bounds_{0};
  Range own_, local_;
};

/// The sum of the products of n numbers, added up as Sum. Where a lambda captures the pointers instead, GCC
/// turns the loop into slow gather instructions.
template <class Sum, class Real>
Sum sum_of_products(const Real* x, const Real* y, std::size_t n) {
  Sum sum = 0;
#pragma omp simd reduction(+ : sum)
  for (std::size_t k = 0; k < n; ++k) sum += static_cast<Sum>(x[k]) * static_cast<Sum>(y[k]);
  return sum;
}

/// The sum over all rows of their scalar products.
template <class Real>
double dot(const Rows<Real>& a, const Rows<Real>& b, const Blocks& blocks) {
  const Real *x = numbers_of(a), *y = numbers_of(b);
  return blocks.sum([=](std::size_t first, std::size_t last) {
    return static_cast<double>(sum_of_products<Real>(x + first, y + first, last - first));
  });
}

/// The largest magnitude of all numbers of rows.
template <class Real>
Real largest(const Rows<Real>& rows) {
  const Real* x = numbers_of(rows);
  Real most = 0;
#pragma omp simd reduction(max : most)
  for (std::size_t k = 0; k < 4 * rows.size(); ++k) most = std::max(most, std::abs(x[k]));
  return most;
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
