#pragma once

#include "multigrid/coarsest_level.hpp"
#include "multigrid/element_transfer.hpp"
#include "multigrid/grid_transfer.hpp"

namespace sandglass {

/// An approximate solution of the saddle-point problem of a body, by one V-cycle over a hierarchy of levels:
/// the elements of the mesh, whatever its shape, and grids of boxes around it, ever coarser.
class SaddleMultigrid {
 public:
  /// `free` is 1, or 0 on constrained components and spare rows; `springs` (N/m) hold rows, empty without
  /// any; `update` must follow.
  SaddleMultigrid(const Mesh& mesh, const Layout& layout, const Rows<float>& free, const Rows<float>& springs,
                  int threads);

  /// Takes the configuration with displacements u, rows of the layout (m), in which no element may be
  /// inverted, and the moduli of each material.
  void update(const Rows<float>& u, const std::vector<ModelModuli>& moduli);

  /// x = an approximate solution for b: linear in b and symmetric, without the pressures positive.
  void cycle(const MixedVector& b, MixedVector& x);

  const ElementLevel& elements() const { return *elements_; }

 private:
  /// A grid and its vectors.
  struct Stage {
    std::unique_ptr<GridLevel> level;
    std::unique_ptr<GridTransfer> to_coarser;  // null on the coarsest
    MixedVector b, x, r;
  };

  void cycle_grid(std::size_t stage);

  std::unique_ptr<ElementLevel> elements_;
  std::vector<Stage> stages_;
  std::unique_ptr<ElementTransfer> to_grid_;
  CoarsestLevel coarsest_;
  MixedVector residual_;
};

}  // namespace sandglass
