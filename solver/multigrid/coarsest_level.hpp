#pragma once

#include <memory>

#include "multigrid/grid_level.hpp"
#include "multigrid/semidefinite_inverse.hpp"

namespace sandglass {

/// The exact solution on a grid of a few boxes: pressures are eliminated, A + B^T C^-1 B is inverted.
class CoarsestLevel {
 public:
  /// Takes the problems of a level, which must live as long.
  void update(const GridLevel& level);

  /// x = the solution for b.
  void solve(const MixedVector& b, MixedVector& x) const;

 private:
  const GridLevel* level_ = nullptr;
  std::vector<std::size_t> rows_;
  std::vector<double> matrix_;
  std::unique_ptr<SemidefiniteInverse> inverse_;
};

}  // namespace sandglass
