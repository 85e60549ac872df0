#include "multigrid/mixed_vector.hpp"

namespace sandglass {

namespace {

double dot(const float* x, const float* y, const Blocks& blocks) {
  return blocks.sum([=](std::size_t first, std::size_t last) {
    return sum_of_products<double>(x + first, y + first, last - first);
  });
}

/// Calls change(first, last, numbers) for the blocks of displacements and of pressures.
template <class Change>
void for_both(MixedVector& x, const MixedBlocks& blocks, const Change& change) {
  float *u = numbers_of(x.u), *p = x.p.data();
  blocks.u.for_each([=](std::size_t first, std::size_t last) { change(first, last, u); });
  blocks.p.for_each([=](std::size_t first, std::size_t last) { change(first, last, p); });
}

void add(float factor, const float* x, float* y, const Blocks& blocks) {
  blocks.for_each([=](std::size_t first, std::size_t last) {
#pragma omp simd
    for (std::size_t k = first; k < last; ++k) y[k] += factor * x[k];
  });
}

}  // namespace

double dot(const MixedVector& a, const MixedVector& b, const MixedBlocks& blocks) {
  return dot(numbers_of(a.u), numbers_of(b.u), blocks.u) + dot(a.p.data(), b.p.data(), blocks.p);
}

void add(float factor, const MixedVector& x, MixedVector& y, const MixedBlocks& blocks) {
  add(factor, numbers_of(x.u), numbers_of(y.u), blocks.u);
  add(factor, x.p.data(), y.p.data(), blocks.p);
}

void multiply(float factor, MixedVector& x, const MixedBlocks& blocks) {
  for_both(x, blocks, [=](std::size_t first, std::size_t last, float* numbers) {
    for (std::size_t k = first; k < last; ++k) numbers[k] *= factor;
  });
}

void clear(MixedVector& x, const MixedBlocks& blocks) {
  for_both(x, blocks, [](std::size_t first, std::size_t last, float* numbers) {
    std::fill(numbers + first, numbers + last, 0.0f);
  });
}

}  // namespace sandglass
