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

/// A coarser level: trilinear displacements on the nodes of a grid, one pressure for each box. Ranks share
/// the work on the lines of a large grid, but each has all values.
class GridLevel final : public SaddleLevel {
 public:
  GridLevel(const Grid& grid, Team team);

  const Grid& grid() const { return grid_; }
  int threads() const { return team_.threads; }

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
    for_lines(extra, 0, lines(extra), visit);
  }

  /// Like for_each_line for a visit that sets `values` of each line: ranks divide the lines and gather the
  /// values.
  template <class T, class Visit>
  void set_by_lines(std::size_t extra, std::vector<T>& values, const Visit& visit) const {
    constexpr std::size_t worth_dividing = 4096;  // nodes
    const auto ranks = static_cast<std::size_t>(team_.ranks->count());
    if (ranks == 1 || grid_.nodes() < worth_dividing) return for_each_line(extra, visit);
    const auto first_line = [&](std::size_t rank) { return lines(extra) * rank / ranks; };
    const auto own = static_cast<std::size_t>(team_.ranks->rank());
    for_lines(extra, first_line(own), first_line(own + 1), visit);
    std::vector<std::size_t> bounds;
    for (std::size_t r = 0; r < ranks; ++r) bounds.push_back(first_of(extra, first_line(r)) * sizeof(T));
    bounds.push_back(values.size() * sizeof(T));
    team_.ranks->gather(reinterpret_cast<std::byte*>(values.data()), bounds);
  }

 protected:
  void for_each_corner(const VisitCorner& visit) const override;

 private:
  /// The lines of boxes along x, or of nodes if `extra` is 1.
  std::size_t lines(std::size_t extra) const { return (grid_.boxes[1] + extra) * (grid_.boxes[2] + extra); }

  /// The number of the first box or node of a line.
  std::size_t first_of(std::size_t extra, std::size_t line) const {
    const std::size_t ny = grid_.boxes[1] + extra;
    return grid_.number(0, line % ny, line / ny);
  }

  template <class Visit>
  void for_lines(std::size_t extra, std::size_t first, std::size_t last, const Visit& visit) const {
    in_parallel(last - first, team_.threads,
                [&](std::size_t k) { visit(first_of(extra, first + k), grid_.boxes[0] + extra); });
  }

  float eigenvalue_bound() const;

  /// Columns of the 3 x 3 blocks of a node's 27 neighbours.
  using Stencil = std::array<Row<float>, 81>;

  Team team_;
  Grid grid_;
  std::vector<BoxProblem> problems_;
  std::vector<Stencil> stencils_;
};

}  // namespace sandglass
