#pragma once

#include "multigrid/grid_level.hpp"

namespace sandglass {

/// Transfers problems, residuals and corrections between a grid and the next coarser one.
class GridTransfer {
 public:
  /// The coarse grid has half as many boxes along the `halved` axes. Both levels must live as long.
  GridTransfer(const GridLevel& fine, GridLevel& coarse, const std::array<bool, 3>& halved);

  /// Sets the problems of the coarse boxes to those of their fine boxes, restricted to coarse functions.
  void gather();

  /// b = the residual r of the fine grid for the coarse one.
  void restrict_residual(const MixedVector& r, MixedVector& b) const;

  /// Adds the coarse correction x to the unknowns of the fine grid.
  void add_correction(const MixedVector& x, MixedVector& fine) const;

 private:
  using Indices = std::array<std::size_t, 3>;

  /// Calls visit(box, octant) for the fine boxes in a coarse one, with the octant that each fills.
  template <class Visit>
  void for_each_part(const Indices& box, const Visit& visit) const;

  /// Calls visit(indices) for all nodes of a grid, or all boxes, in parallel by lines.
  template <class Visit>
  void for_all(const Indices& counts, const Visit& visit) const;

  BoxProblem problem_of(const Indices& box) const;

  const GridLevel& fine_;
  GridLevel& coarse_;
  std::array<bool, 3> halved_;
  std::array<std::array<std::array<float, 8>, 8>, 8> weights_;  // of coarse corners, by octant and its corner
};

}  // namespace sandglass
