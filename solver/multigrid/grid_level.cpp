#include "multigrid/grid_level.hpp"

#include <algorithm>
#include <cmath>

#include "math/matrix.hpp"

namespace sandglass {

namespace {

/// As for the elements; here one step less suffices.
constexpr int pressure_steps = 2;

}  // namespace

GridLevel::GridLevel(const Grid& grid, Team team)
    : SaddleLevel({Blocks(4 * grid.nodes(), team.threads), Blocks(grid.nodes(), team.threads)},
                  pressure_steps),
      team_(std::move(team)),
      grid_(grid),
      problems_(grid.nodes()),
      stencils_(grid.nodes()) {
  resize(grid.nodes(), grid.nodes());
}

void GridLevel::assemble() {
  Rows<float> diagonal(grid_.nodes());
  set_by_lines(1, diagonal, [&](std::size_t first, std::size_t count) {
    for (std::size_t n = first; n < first + count; ++n) {
      Stencil& stencil = stencils_[n];
      stencil.fill({});
      for (std::size_t a = 0; a < 8; ++a) {
        const auto& A = problems_[n - grid_.corner(a)].A;
        for (std::size_t b = 0; b < 8; ++b) {
          std::size_t neighbour = 0;
          for (std::size_t i = 0, power = 1; i < 3; ++i, power *= 3) {
            neighbour += power * (1 + (b >> i & 1) - (a >> i & 1));
          }
          for (std::size_t j = 0; j < 3; ++j) {
            for (std::size_t i = 0; i < 3; ++i) {
              stencil[3 * neighbour + j][i] += A[24 * (3 * a + i) + 3 * b + j];
            }
          }
        }
      }
      const Row<float>* own = &stencil[39];
      diagonal[n] = {{own[0][0], own[1][1], own[2][2], 0.0f}};
    }
  });
  for (std::size_t n = 0; n < diagonal.size(); ++n) {
    for (std::size_t i = 0; i < 3; ++i) free_[n][i] = diagonal[n][i] > 0.0f ? 1.0f : 0.0f;
  }
  for (std::size_t box = 0; box < problems_.size(); ++box) compliance_[box] = problems_[box].C;
  set_smoother(diagonal, eigenvalue_bound());
}

/// A bound of the eigenvalues of D^-1 A, D the diagonal, from single boxes by power iteration: a sum of boxes
/// has no larger eigenvalue.
float GridLevel::eigenvalue_bound() const {
  std::vector<float> largest(grid_.nodes(), 1.0f);
  set_by_lines(0, largest, [&](std::size_t first, std::size_t count) {
    for (std::size_t box = first; box < first + count; ++box) {
      const auto& A = problems_[box].A;
      std::array<float, 24> x, y;
      for (std::size_t m = 0; m < 24; ++m)
        x[m] = 1.0f + 0.37f * static_cast<float>(static_cast<int>(7 * m % 11) - 5);
      for (int k = 0; k < 8; ++k) {
        y.fill(0.0f);
        for (std::size_t m = 0; m < 24; ++m) {
          const float* row = &A[24 * m];
#pragma omp simd
          for (std::size_t n = 0; n < 24; ++n) y[n] += x[m] * row[n];
        }
        float square = 0.0f;
        for (std::size_t m = 0; m < 24; ++m) {
          const float own = A[25 * m];
          x[m] = own > 0.0f ? y[m] / own : 0.0f;
          square += x[m] * x[m];
        }
        const float size = std::sqrt(square);
        if (!(size > 0.0f)) break;
        largest[box] = size;
        for (float& v : x) v /= size;
      }
    }
  });
  return 1.05f * *std::max_element(largest.begin(), largest.end());
}

void GridLevel::for_each_corner(const VisitCorner& visit) const {
  for (std::size_t box = 0; box < problems_.size(); ++box) {
    if (!(problems_[box].C > 0.0f)) continue;
    const auto& B = problems_[box].B;
    for (std::size_t a = 0; a < 8; ++a) {
      visit(box, box + grid_.corner(a), {B[3 * a], B[3 * a + 1], B[3 * a + 2]});
    }
  }
}

void GridLevel::apply(const MixedVector& x, MixedVector& y) const {
  const float* u = numbers_of(x.u);
  set_by_lines(1, y.u, [&](std::size_t first, std::size_t count) {
    std::array<std::size_t, 27> offsets;
    for (std::size_t m = 0; m < 27; ++m) {
      offsets[m] = m % 3 + m / 3 % 3 * grid_.stride(1) + m / 9 * grid_.stride(2);
    }
    const std::size_t origin = 1 + grid_.stride(1) + grid_.stride(2);
    for (std::size_t n = first; n < first + count; ++n) {
      RowVector<float, 4> sum{};
      const Stencil& stencil = stencils_[n];
      for (std::size_t m = 0; m < 27; ++m) {
        const float* v = u + 4 * (n + offsets[m] - origin);
        for (std::size_t j = 0; j < 3; ++j) sum += load<4>(stencil[3 * m + j].x.data()) * v[j];
      }
      for (std::size_t a = 0; a < 8; ++a) {
        const std::size_t box = n - grid_.corner(a);
        for (std::size_t i = 0; i < 3; ++i)
          sum[static_cast<int>(i)] += problems_[box].B[3 * a + i] * x.p[box];
      }
      store(sum, y.u[n].x.data());
    }
  });
  divergence(x.u, y.p);
  for (std::size_t box = 0; box < y.p.size(); ++box) y.p[box] -= compliance_[box] * x.p[box];
}

void GridLevel::divergence(const Rows<float>& u, std::vector<float>& g) const {
  set_by_lines(0, g, [&](std::size_t first, std::size_t count) {
    for (std::size_t box = first; box < first + count; ++box) {
      float sum = 0.0f;
      const auto& B = problems_[box].B;
      for (std::size_t a = 0; a < 8; ++a) {
        const Row<float>& v = u[box + grid_.corner(a)];
        for (std::size_t i = 0; i < 3; ++i) sum += B[3 * a + i] * v[i];
      }
      g[box] = sum;
    }
  });
}

void GridLevel::gradient(const std::vector<float>& p, Rows<float>& f) const {
  set_by_lines(1, f, [&](std::size_t first, std::size_t count) {
    for (std::size_t n = first; n < first + count; ++n) {
      Row<float> sum;
      for (std::size_t a = 0; a < 8; ++a) {
        const std::size_t box = n - grid_.corner(a);
        for (std::size_t i = 0; i < 3; ++i) sum[i] += problems_[box].B[3 * a + i] * p[box];
      }
      f[n] = sum;
    }
  });
}

}  // namespace sandglass
