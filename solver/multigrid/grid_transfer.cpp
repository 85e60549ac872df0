#include "multigrid/grid_transfer.hpp"

namespace sandglass {

GridTransfer::GridTransfer(const GridLevel& fine, GridLevel& coarse, const std::array<bool, 3>& halved)
    : fine_(fine), coarse_(coarse), halved_(halved) {
  for (std::size_t octant = 0; octant < 8; ++octant) {
    for (std::size_t c = 0; c < 8; ++c) {
      std::array<float, 3> local;
      for (std::size_t i = 0; i < 3; ++i) {
        const auto corner = static_cast<float>(c >> i & 1), half = static_cast<float>(octant >> i & 1);
        local[i] = halved[i] ? 0.5f * (half + corner) : corner;
      }
      weights_[octant][c] = weights(local);
    }
  }
}

template <class Visit>
void GridTransfer::for_each_part(const Indices& box, const Visit& visit) const {
  const Grid& grid = fine_.grid();
  for (std::size_t octant = 0; octant < 8; ++octant) {
    Indices part;
    bool exists = true;
    for (std::size_t i = 0; i < 3; ++i) {
      const std::size_t upper = octant >> i & 1;
      part[i] = halved_[i] ? 2 * box[i] + upper : box[i];
      exists = exists && part[i] < grid.boxes[i] && (halved_[i] || upper == 0);
    }
    if (exists) visit(grid.number(part[0], part[1], part[2]), octant);
  }
}

template <class Visit>
void GridTransfer::for_all(const Indices& counts, const Visit& visit) const {
  in_parallel(counts[1] * counts[2], fine_.threads(), [&](std::size_t line) {
    for (std::size_t i = 0; i < counts[0]; ++i) visit(Indices{i, line % counts[1], line / counts[1]});
  });
}

void GridTransfer::gather() {
  const Grid& grid = coarse_.grid();
  coarse_.set_by_lines(0, coarse_.problems(), [&](std::size_t first, std::size_t count) {
    for (std::size_t i = 0; i < count; ++i) {
      const Indices box{i, first % grid.stride(2) / grid.stride(1) - 1, first / grid.stride(2) - 1};
      coarse_.problems()[first + i] = problem_of(box);
    }
  });
}

BoxProblem GridTransfer::problem_of(const Indices& box) const {
  BoxProblem problem{};
  for_each_part(box, [&](std::size_t part, std::size_t octant) {
    const BoxProblem& fine = fine_.problems()[part];
    if (!(fine.C > 0.0f)) return;
    const auto& w = weights_[octant];
    std::array<float, 576> right{};  // A times the interpolation
    for (std::size_t m = 0; m < 24; ++m) {
      for (std::size_t d = 0; d < 8; ++d) {
        for (std::size_t b = 0; b < 8; ++b) {
          if (w[d][b] == 0.0f) continue;
          for (std::size_t j = 0; j < 3; ++j)
            right[24 * m + 3 * b + j] += fine.A[24 * m + 3 * d + j] * w[d][b];
        }
      }
    }
    for (std::size_t c = 0; c < 8; ++c) {
      for (std::size_t a = 0; a < 8; ++a) {
        if (w[c][a] == 0.0f) continue;
        for (std::size_t i = 0; i < 3; ++i) {
          problem.B[3 * a + i] += w[c][a] * fine.B[3 * c + i];
          const float* row = &right[24 * (3 * c + i)];
          float* sum = &problem.A[24 * (3 * a + i)];
#pragma omp simd
          for (std::size_t n = 0; n < 24; ++n) sum[n] += w[c][a] * row[n];
        }
      }
    }
    problem.C += fine.C;
  });
  return problem;
}

void GridTransfer::restrict_residual(const MixedVector& r, MixedVector& b) const {
  const Grid &fine = fine_.grid(), &coarse = coarse_.grid();
  for_all({coarse.boxes[0] + 1, coarse.boxes[1] + 1, coarse.boxes[2] + 1}, [&](const Indices& at) {
    // The fine nodes around, and the coarse function there; nodes beyond the grid are unused ones.
    std::array<std::array<std::size_t, 3>, 3> near;
    std::array<std::array<float, 3>, 3> w;
    for (std::size_t i = 0; i < 3; ++i) {
      const std::size_t middle = halved_[i] ? 2 * at[i] : at[i];
      for (std::size_t m = 0; m < 3; ++m) {
        const bool inside = middle + m >= 1 && middle + m - 1 <= fine.boxes[i];
        near[i][m] = inside ? middle + m - 1 : 0;
        w[i][m] = !inside ? 0.0f : m == 1 ? 1.0f : halved_[i] ? 0.5f : 0.0f;
      }
    }
    Row<float> sum;
    for (std::size_t c = 0; c < 3; ++c) {
      for (std::size_t d = 0; d < 3; ++d) {
        const float plane = w[2][c] * w[1][d];
        if (plane == 0.0f) continue;
        for (std::size_t m = 0; m < 3; ++m) {
          const Row<float>& from = r.u[fine.number(near[0][m], near[1][d], near[2][c])];
          for (std::size_t i = 0; i < 4; ++i) sum[i] += plane * w[0][m] * from[i];
        }
      }
    }
    b.u[coarse.number(at[0], at[1], at[2])] = sum;
  });
  for_all(coarse.boxes, [&](const Indices& box) {
    float sum = 0.0f;
    for_each_part(box, [&](std::size_t part, std::size_t /*octant*/) { sum += r.p[part]; });
    b.p[coarse.number(box[0], box[1], box[2])] = sum;
  });
}

void GridTransfer::add_correction(const MixedVector& x, MixedVector& fine) const {
  const Grid &to = fine_.grid(), &coarse = coarse_.grid();
  for_all({to.boxes[0] + 1, to.boxes[1] + 1, to.boxes[2] + 1}, [&](const Indices& at) {
    Indices low, high;  // coarse nodes on both sides
    for (std::size_t i = 0; i < 3; ++i) {
      low[i] = halved_[i] ? at[i] / 2 : at[i];
      high[i] = halved_[i] ? (at[i] + 1) / 2 : at[i];
    }
    Row<float> sum;
    for (std::size_t c = 0; c < 8; ++c) {
      const auto pick = [&](std::size_t axis) { return (c >> axis & 1) != 0 ? high[axis] : low[axis]; };
      const Row<float>& v = x.u[coarse.number(pick(0), pick(1), pick(2))];
      for (std::size_t i = 0; i < 4; ++i) sum[i] += 0.125f * v[i];
    }
    Row<float>& own = fine.u[to.number(at[0], at[1], at[2])];
    for (std::size_t i = 0; i < 4; ++i) own[i] += sum[i];
  });
  for_all(coarse.boxes, [&](const Indices& box) {
    const float p = x.p[coarse.number(box[0], box[1], box[2])];
    for_each_part(box, [&](std::size_t part, std::size_t /*octant*/) { fine.p[part] += p; });
  });
}

}  // namespace sandglass
