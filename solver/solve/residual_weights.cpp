#include "solve/residual_weights.hpp"

#include <algorithm>
#include <cmath>

#include "math/row_loops.hpp"

namespace sandglass {

void ResidualWeights::set_forces(const ElementLevel& level) {
  const float* D = numbers_of(level.diagonal());
  float* weights = numbers_of(diagonal_.u);
  level.blocks().u.for_each([=](std::size_t first, std::size_t last) {
    for (std::size_t k = first; k < last; ++k) weights[k] = std::sqrt(D[k]);
  });
  couplings_.clear();
  for (const auto& [row, ground, stiffness, change] : level.touching()) {
    const Tensor<float> L = cholesky(level.relaxation(row));
    for (int i = 0; i < 3; ++i) diagonal_.u[row][static_cast<std::size_t>(i)] = L(i, i);
    couplings_.push_back({row, L(1, 0), L(2, 0), L(2, 1)});
  }
}

void ResidualWeights::set_pressure(std::size_t cell, double shear_modulus, double volume) {
  diagonal_.p[cell] = static_cast<float>(std::sqrt(shear_modulus / volume));
}

void ResidualWeights::multiply(MixedVector& residuals, const MixedBlocks& blocks) const {
  for (const auto& [row, yx, zx, zy] : couplings_) {  // the diagonal follows
    Row<float>& f = residuals.u[row];
    const Row<float>& w = diagonal_.u[row];
    if (w[0] > 0.0f) f[0] += (yx * f[1] + zx * f[2]) / w[0];
    if (w[1] > 0.0f) f[1] += zy * f[2] / w[1];
  }
  const auto multiply = [](const float* w, float* r, const Blocks& numbers) {
    numbers.for_each([=](std::size_t first, std::size_t last) {
#pragma omp simd
      for (std::size_t k = first; k < last; ++k) r[k] *= w[k];
    });
  };
  multiply(numbers_of(diagonal_.u), numbers_of(residuals.u), blocks.u);
  multiply(diagonal_.p.data(), residuals.p.data(), blocks.p);
}

void ResidualWeights::divide(float factor, const MixedVector& weighted, MixedVector& residuals,
                             const MixedBlocks& blocks) const {
  const auto divide = [=](const float* r, const float* w, float* b, const Blocks& numbers) {
    numbers.for_each([=](std::size_t first, std::size_t last) {
#pragma omp simd
      for (std::size_t k = first; k < last; ++k) b[k] = w[k] > 0.0f ? factor * r[k] / w[k] : 0.0f;
    });
  };
  divide(numbers_of(weighted.u), numbers_of(diagonal_.u), numbers_of(residuals.u), blocks.u);
  divide(weighted.p.data(), diagonal_.p.data(), residuals.p.data(), blocks.p);
  for (const auto& [row, yx, zx, zy] : couplings_) {
    Row<float>& f = residuals.u[row];
    const Row<float>& w = diagonal_.u[row];
    if (w[1] > 0.0f) f[1] -= zy * f[2] / w[1];
    if (w[0] > 0.0f) f[0] -= (yx * f[1] + zx * f[2]) / w[0];
  }
}

}  // namespace sandglass
