#include "multigrid/mixed_vector.hpp"

#include "math/row_loops.hpp"

namespace sandglass {

namespace {

double dot(const float* x, const float* y, std::size_t n, int threads) {
  return sum_over_blocks<double>(n, threads, [=](std::size_t first, std::size_t last) {
    double sum = 0;
#pragma omp simd reduction(+ : sum)
    for (std::size_t k = first; k < last; ++k) sum += static_cast<double>(x[k]) * static_cast<double>(y[k]);
    return sum;
  });
}

/// Calls visit(numbers, count) for displacements and for pressures.
template <class Visit>
void for_both(MixedVector& x, const Visit& visit) {
  visit(numbers_of(x.u), 4 * x.u.size());
  visit(x.p.data(), x.p.size());
}

void add(float factor, const float* x, float* y, std::size_t n, int threads) {
  for_each_block(n, threads, [=](std::size_t first, std::size_t last) {
#pragma omp simd
    for (std::size_t k = first; k < last; ++k) y[k] += factor * x[k];
  });
}

}  // namespace

double dot(const MixedVector& a, const MixedVector& b, int threads) {
  return dot(numbers_of(a.u), numbers_of(b.u), 4 * a.u.size(), threads) +
         dot(a.p.data(), b.p.data(), a.p.size(), threads);
}

void add(float factor, const MixedVector& x, MixedVector& y, int threads) {
  add(factor, numbers_of(x.u), numbers_of(y.u), 4 * x.u.size(), threads);
  add(factor, x.p.data(), y.p.data(), x.p.size(), threads);
}

void multiply(float factor, MixedVector& x, int threads) {
  for_both(x, [&](float* numbers, std::size_t n) {
    for_each_block(n, threads, [=](std::size_t first, std::size_t last) {
      for (std::size_t k = first; k < last; ++k) numbers[k] *= factor;
    });
  });
}

void clear(MixedVector& x, int threads) {
  for_both(x, [&](float* numbers, std::size_t n) {
    for_each_block(n, threads, [=](std::size_t first, std::size_t last) {
      std::fill(numbers + first, numbers + last, 0.0f);
    });
  });
}

}  // namespace sandglass
