#include "multigrid/coarsest_level.hpp"

namespace sandglass {

void CoarsestLevel::update(const GridLevel& level) {
  level_ = &level;
  const Grid& grid = level.grid();
  rows_.clear();
  std::vector<std::size_t> index(grid.nodes());
  for (std::size_t k = 0; k <= grid.boxes[2]; ++k) {
    for (std::size_t j = 0; j <= grid.boxes[1]; ++j) {
      for (std::size_t i = 0; i <= grid.boxes[0]; ++i) {
        index[grid.number(i, j, k)] = rows_.size();
        rows_.push_back(grid.number(i, j, k));
      }
    }
  }
  const std::size_t size = 3 * rows_.size();
  matrix_.assign(size * size, 0.0);
  for (std::size_t box = 0; box < grid.nodes(); ++box) {
    const BoxProblem& problem = level.problems()[box];
    if (!(problem.C > 0.0f)) continue;
    std::array<std::size_t, 24> place;
    for (std::size_t m = 0; m < 24; ++m) place[m] = 3 * index[box + grid.corner(m / 3)] + m % 3;
    for (std::size_t m = 0; m < 24; ++m) {
      for (std::size_t n = 0; n < 24; ++n) {
        // A is symmetric but for its rounding
        const double A =
            0.5 * (static_cast<double>(problem.A[24 * m + n]) + static_cast<double>(problem.A[24 * n + m]));
        matrix_[place[m] * size + place[n]] += A + static_cast<double>(problem.B[m]) *
                                                       static_cast<double>(problem.B[n]) /
                                                       static_cast<double>(problem.C);
      }
    }
  }
  if (inverse_ == nullptr) inverse_ = std::make_unique<SemidefiniteInverse>(size);
  inverse_->invert(matrix_);
}

void CoarsestLevel::solve(const MixedVector& b, MixedVector& x) const {
  const Grid& grid = level_->grid();
  std::vector<double> f(3 * rows_.size()), u(f.size());
  std::vector<float> p(b.p.size());
  const auto& problems = level_->problems();
  for (std::size_t box = 0; box < p.size(); ++box) {
    if (problems[box].C > 0.0f) p[box] = b.p[box] / problems[box].C;
  }
  MixedVector carried{Rows<float>(b.u.size()), {}};
  level_->gradient(p, carried.u);
  for (std::size_t n = 0; n < rows_.size(); ++n) {
    for (std::size_t i = 0; i < 3; ++i) {
      f[3 * n + i] = static_cast<double>(b.u[rows_[n]][i]) + static_cast<double>(carried.u[rows_[n]][i]);
    }
  }
  inverse_->solve(f, u);
  for (std::size_t n = 0; n < rows_.size(); ++n) {
    for (std::size_t i = 0; i < 3; ++i) x.u[rows_[n]][i] = static_cast<float>(u[3 * n + i]);
  }
  // In double precision: B u and g may cancel.
  for (std::size_t box = 0; box < p.size(); ++box) {
    if (!(problems[box].C > 0.0f)) continue;
    double change = -static_cast<double>(b.p[box]);
    for (std::size_t m = 0; m < 24; ++m) {
      change +=
          static_cast<double>(problems[box].B[m]) * static_cast<double>(x.u[box + grid.corner(m / 3)][m % 3]);
    }
    x.p[box] = static_cast<float>(change / static_cast<double>(problems[box].C));
  }
}

}  // namespace sandglass
