#include "solve/acceleration.hpp"

#include <algorithm>
#include <cmath>

#include "math/dense.hpp"

namespace sandglass {

/// Adds the last step and the change of the residual along it.
void Acceleration::remember(const MixedVector& residual) {
  const double largest_square = most_times_residual * most_times_residual * dot(residual, residual, blocks_);
  const auto useless = [&](const Pair& pair) { return pair.with_earlier.back() > largest_square; };
  while (!pairs_.empty() && (pairs_.size() == most_pairs || useless(pairs_.front()))) {
    pairs_.pop_front();
    for (Pair& pair : pairs_) pair.with_earlier.erase(pair.with_earlier.begin());
  }
  Pair pair{std::move(step_), residual, {}, 0.0};
  add(-1.0f, before_, pair.change, blocks_);
  for (Pair& earlier : pairs_) {
    const double product = dot(earlier.change, pair.change, blocks_);
    earlier.with_residual += product;
    pair.with_earlier.push_back(product);
  }
  pair.with_earlier.push_back(dot(pair.change, pair.change, blocks_));
  pair.with_residual = dot(pair.change, residual, blocks_);
  pairs_.push_back(std::move(pair));
  has_step_ = false;
}

/// The shares of the changes whose sum is closest to the residual, by normal equations with unit diagonal.
std::vector<double> Acceleration::best_shares() const {
  // Added to the diagonal: steps may be nearly dependent, and products of vectors in single precision are
  // rounded to about this. A combination that relies on smaller differences is useless.
  constexpr double least = 1e-6;
  const std::size_t n = pairs_.size();
  std::vector<double> products(n * n), scale(n), shares(n);
  for (std::size_t i = 0; i < n; ++i) {
    const Pair& pair = pairs_[i];
    scale[i] = 1.0 / std::sqrt(std::max(pair.with_earlier.back(), 1e-300));
    for (std::size_t j = 0; j <= i; ++j) products[i * n + j] = scale[i] * scale[j] * pair.with_earlier[j];
    products[i * n + i] += least;
    shares[i] = scale[i] * pair.with_residual;
  }
  shares = solve_positive_definite(products, std::move(shares));
  for (std::size_t i = 0; i < n; ++i) shares[i] *= scale[i];
  return shares;
}

void Acceleration::combine(MixedVector& residual, MixedVector& step) {
  if (has_step_) remember(residual);
  before_ = residual;
  sandglass::clear(step, blocks_);
  if (pairs_.empty()) return;
  const std::vector<double> shares = best_shares();
  for (std::size_t i = 0; i < shares.size(); ++i) {
    add(static_cast<float>(-shares[i]), pairs_[i].change, residual, blocks_);
    add(static_cast<float>(-shares[i]), pairs_[i].step, step, blocks_);
  }
}

}  // namespace sandglass
