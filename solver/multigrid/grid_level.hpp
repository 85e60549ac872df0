#pragma once

#include "base/parallel.hpp"
#include "multigrid/grid.hpp"
#include "multigrid/saddle_level.hpp"

namespace sandglass {

/// The saddle-point problem of one box, on the components of its eight corners.
struct BoxProblem {
  std::array<float, 576> A{};
  std::array<float, 24> B{};
  float C = 0.0f;  ///< zero without elements
};

/// A coarser level: trilinear displacements on the nodes of a grid, one pressure for each of its boxes.
class GridLevel final : public SaddleLevel {
 public:
  GridLevel(const Grid& grid, int threads);

  const Grid& grid() const { return grid_; }
  int threads() const { return threads_; }

  /// The problems of the boxes, by number; `assemble` must follow a change.
  std::vector<BoxProblem>& problems() { return problems_; }
  const std::vector<BoxProblem>& problems() const { return problems_; }

  /// Sets up the level from the problems of its boxes.
  void assemble();

  void apply(const MixedVector& x, MixedVector& y) const override;
  void divergence(const Rows<float>& u, std::vector<float>& g) const override;
  void gradient(const std::vector<float>& p, Rows<float>& f) const override;

  /// Calls visit(first, count) for the lines of boxes along x, or of nodes if `extra` is 1, in parallel.
  template <class Visit>
  void for_each_line(std::size_t extra, const Visit& visit) const {
    const std::size_t ny = grid_.boxes[1] + extra, nz = grid_.boxes[2] + extra;
    in_parallel(ny * nz, threads_, [&](std::size_t line) {
      visit(grid_.number(0, line % ny, line / ny), grid_.boxes[0] + extra);
    });
  }

 protected:
  void for_each_corner(const VisitCorner& visit) const override;

 private:
  float eigenvalue_bound() const;

  /// Columns of the 3 x 3 blocks of a node's 27 neighbours.
  using Stencil = std::array<Row<float>, 81>;

  int threads_;
  Grid grid_;
  std::vector<BoxProblem> problems_;
  std::vector<Stencil> stencils_;
};

}  // namespace sandglass
