#include "multigrid/saddle_level.hpp"

#include <algorithm>
#include <cmath>

#include "math/matrix.hpp"
#include "math/row_loops.hpp"

namespace sandglass {

namespace {

/// Calls body(k) for all numbers of blocks, in parallel.
template <class Body>
void for_all(const Blocks& blocks, const Body& body) {
  blocks.for_each([&](std::size_t first, std::size_t last) {
#pragma omp simd
    for (std::size_t k = first; k < last; ++k) body(k);
  });
}

/// The scale of D, see SaddleLevel::relaxation.
constexpr float relaxation_step = 1.3f;

/// The smallest square of a pivot, as a share of the diagonal: less is rounding.
constexpr float least_pivot = 1e-6f;

/// u += factor E f.
void add_product(float factor, const Tensor<float>& E, const Row<float>& f, Row<float>& u) {
  for (int i = 0; i < 3; ++i)
    u[static_cast<std::size_t>(i)] += factor * (E(i, 0) * f[0] + E(i, 1) * f[1] + E(i, 2) * f[2]);
}

/// What springs K (N/m) of a row add to the diagonal of D (m/N): by the formula of Sherman and Morrison for
/// each column of the root of K, because D may be singular.
Tensor<float> change_by(const Tensor<float>& K, const Row<float>& diagonal) {
  const Tensor<float> root = cholesky(K);
  Tensor<float> change{};
  for (int column = 0; column < 3; ++column) {
    const float pivot = root(column, column);
    if (!(pivot * pivot > 2.0f * least_pivot * K(column, column))) continue;  // rounding
    Row<float> s{{root(0, column), root(1, column), root(2, column)}}, Ds{};
    for (std::size_t i = 0; i < 3; ++i) Ds[i] = diagonal[i] * s[i];
    add_product(1.0f, change, s, Ds);
    add_square(-1.0f / (relaxation_step + Ds[0] * s[0] + Ds[1] * s[1] + Ds[2] * s[2]), Ds, change);
  }
  return change;
}

/// The largest eigenvalue of D M, M symmetric, within 3^(1/4): the trace of the fourth power bounds its
/// fourth power.
float eigenvalue_bound(const Tensor<float>& D, const Tensor<float>& M) {
  Tensor<float> DM = D * M;
  DM = DM * DM;
  DM = DM * DM;
  return std::sqrt(std::sqrt(DM(0, 0) + DM(1, 1) + DM(2, 2)));
}

}  // namespace

Tensor<float> cholesky(const Tensor<float>& K) {
  Tensor<float> L{};
  for (int j = 0; j < 3; ++j) {
    for (int i = j; i < 3; ++i) {
      float left = K(i, j);
      for (int k = 0; k < j; ++k) left -= L(i, k) * L(j, k);
      L(i, j) = i == j           ? std::sqrt(std::max(left, least_pivot * K(i, i)))
                : L(j, j) > 0.0f ? left / L(j, j)
                                 : 0.0f;
    }
  }
  return L;
}

void SaddleLevel::resize(std::size_t rows, std::size_t cells) {
  free_.assign(rows, {});
  diagonal_.assign(rows, {});
  compliance_.assign(cells, 0.0f);
  schur_.assign(cells, 0.0f);
  y_ = zero();
  t_.resize(rows);
  r_.resize(cells);
  change_.resize(cells);
  sum_.resize(cells);
}

void SaddleLevel::set_contact(const std::vector<Spring>& springs) {
  contact_ = springs;
  touching_.clear();
  place_of_row_.assign(free_.size(), -1);
  for (const Spring& spring : springs) {
    float sum = 0.0f;
    for (std::size_t n = 0; n < spring.size; ++n) sum += std::abs(spring.weights[n]);
    for (std::size_t n = 0; n < spring.size; ++n) {
      const auto row = static_cast<std::size_t>(spring.nodes[n]);
      int& place = place_of_row_[row];
      if (place < 0) {
        place = static_cast<int>(touching_.size());
        touching_.push_back({.row = row});
      }
      Touching& one = touching_[static_cast<std::size_t>(place)];
      // The square of a sum is at most the sum of squares with these factors.
      add_square(sum * std::abs(spring.weights[n]), spring.root, one.stiffness);
      if (spring.size == 1) add_square(1.0f, spring.root, one.ground);
    }
  }
  touching_forces_.resize(touching_.size());
}

void SaddleLevel::set_smoother(const Rows<float>& diagonal, float bound) {
  for (std::size_t r = 0; r < free_.size(); ++r) {
    for (std::size_t i = 0; i < 3; ++i) {
      diagonal_[r][i] = free_[r][i] > 0.0f ? relaxation_step / (bound * diagonal[r][i]) : 0.0f;
    }
  }
  for (Touching& one : touching_) one.change = change_by(one.stiffness, diagonal_[one.row]);
  // At each node, S couples the cells around it through M = sum of b b^T / (b^T D b): the largest eigenvalue
  // of D M over all nodes bounds those of diag(S)^-1 S.
  schur_ = compliance_;
  std::vector<Tensor<float>> M(free_.size());
  for_each_corner([&](std::size_t cell, std::size_t row, const std::array<float, 3>& b) {
    const Row<float>& D = diagonal_[row];
    Row<float> Db{{D[0] * b[0], D[1] * b[1], D[2] * b[2]}};
    if (const Touching* one = touching_at(row)) add_product(1.0f, one->change, {{b[0], b[1], b[2]}}, Db);
    const float own = Db[0] * b[0] + Db[1] * b[1] + Db[2] * b[2];
    schur_[cell] += own;
    if (!(own > 0.0f)) return;
    for (std::size_t i = 0; i < 3; ++i) {
      for (std::size_t j = 0; j < 3; ++j) {
        M[row](static_cast<int>(i), static_cast<int>(j)) += b[i] * b[j] / own;
      }
    }
  });
  float largest = 1.0f;
  for (std::size_t r = blocks_.u.own().first / 4; r < blocks_.u.own().last / 4; ++r)
    largest = std::max(largest, eigenvalue_bound(relaxation(r), M[r]));
  largest = static_cast<float>(blocks_.u.ranks().largest(largest));
  for (float& s : schur_) s = s > 0.0f ? 1.0f / (largest * s) : 0.0f;
}

Tensor<float> SaddleLevel::relaxation(std::size_t row) const {
  Tensor<float> full{};
  for (int i = 0; i < 3; ++i) full(i, i) = diagonal_[row][static_cast<std::size_t>(i)];
  const Touching* one = touching_at(row);
  return one != nullptr ? full + one->change : full;
}

void SaddleLevel::relax(float share, const Rows<float>& f, Rows<float>& u) const {
  const float *D = numbers_of(diagonal_), *force = numbers_of(f);
  float* moved = numbers_of(u);
  for_all(blocks_.u, [=](std::size_t k) { moved[k] += share * D[k] * force[k]; });
  for (const Touching& one : touching_) add_product(share, one.change, f[one.row], u[one.row]);
}

void SaddleLevel::smooth_from_zero(const MixedVector& b, MixedVector& x) {
  clear(x, blocks_);
  relax(1.0f, b.u, x.u);
  relax_pressures(b, x);
}

void SaddleLevel::smooth(const MixedVector& b, MixedVector& x) {
  apply(x, y_);
  const float* f = numbers_of(b.u);
  float* y = numbers_of(y_.u);
  for_all(blocks_.u, [=](std::size_t k) { y[k] = f[k] - y[k]; });
  relax(1.0f, y_.u, x.u);
  relax_pressures(b, x);
}

void SaddleLevel::relax_pressures(const MixedVector& b, MixedVector& x) {
  const float *C = compliance_.data(), *D = numbers_of(diagonal_), *S = schur_.data();
  float *r = r_.data(), *d = change_.data(), *q = sum_.data(), *t = numbers_of(t_), *p = x.p.data();
  follow(x.u);
  divergence(x.u, r_);
  // Chebyshev steps for eigenvalues between 1 / n^2 and 1, n the number of steps.
  const float least = 1.0f / static_cast<float>(pressure_steps_ * pressure_steps_);
  const float centre = 0.5f * (1.0f + least), radius = 0.5f * (1.0f - least), sigma = centre / radius;
  float rho = 1.0f / sigma;
  for_all(blocks_.p, [=, g = b.p.data()](std::size_t k) {
    r[k] -= C[k] * p[k] + g[k];
    q[k] = d[k] = S[k] * r[k] / centre;
  });
  for (int step = 1; step < pressure_steps_; ++step) {
    gradient(change_, t_);
    for (std::size_t n = 0; n < touching_.size(); ++n) touching_forces_[n] = t_[touching_[n].row];
    for_all(blocks_.u, [=](std::size_t k) { t[k] *= D[k]; });
    for (std::size_t n = 0; n < touching_.size(); ++n)
      add_product(1.0f, touching_[n].change, touching_forces_[n], t_[touching_[n].row]);
    follow(t_);
    divergence(t_, y_.p);
    const float next = 1.0f / (2.0f * sigma - rho), keep = next * rho, add = 2.0f * next / radius;
    rho = next;
    for_all(blocks_.p, [=, y = y_.p.data()](std::size_t k) {
      r[k] -= y[k] + C[k] * d[k];
      d[k] = keep * d[k] + add * S[k] * r[k];
      q[k] += d[k];
    });
  }
  for_all(blocks_.p, [=](std::size_t k) { p[k] += q[k]; });
  gradient(sum_, t_);
  relax(-1.0f, t_, x.u);
  follow(x.u);
}

void SaddleLevel::residual(const MixedVector& b, const MixedVector& x, MixedVector& r) const {
  apply(x, r);
  const float *f = numbers_of(b.u), *free = numbers_of(free_), *g = b.p.data();
  float *y = numbers_of(r.u), *z = r.p.data();
  for_all(blocks_.u, [=](std::size_t k) { y[k] = free[k] * (f[k] - y[k]); });
  for_all(blocks_.p, [=](std::size_t k) { z[k] = g[k] - z[k]; });
}

}  // namespace sandglass
