#pragma once

#include "multigrid/coarsest_level.hpp"
#include "multigrid/element_transfer.hpp"
#include "multigrid/grid_transfer.hpp"
#include "multigrid/mesh_transfer.hpp"

namespace sandglass {

/// An approximate solution of the saddle-point problem of a body, by one V-cycle over a hierarchy of levels:
/// the elements of the mesh, the elements that were split into them, and ever coarser grids of boxes around
/// these. Ranks divide the elements of the mesh; each has all coarser levels.
class SaddleMultigrid {
 public:
  /// `ties` are the mesh's, `coarser` the meshes from which it was refined, the last one first. `free` is 1,
  /// or 0 on constrained components, tied nodes and unused rows; `springs` (N/m) hold rows and may be empty;
  /// `update` must follow.
  SaddleMultigrid(const Mesh& mesh, const Ties& ties, const std::vector<CoarserMesh>& coarser,
                  const Layout& layout, const Rows<float>& free, const Rows<float>& springs);

  /// Takes the configuration with displacements u, rows of the layout (m), in which no element may be
  /// inverted, the moduli of each material, and for each cell of the mesh the stiffening of the law.
  void update(const Rows<float>& u, const std::vector<ModelModuli>& moduli,
              const std::vector<float>& stiffening);

  /// See SaddleLevel::set_contact. Coarser meshes have the springs to the ground of their nodes, and no
  /// others. On grids, nodes at one place move together, as those do that springs connect. `update` or
  /// `update_contact` must follow.
  void set_contact(const std::vector<Spring>& springs);

  /// Takes these springs in the configuration of the last `update`.
  void update_contact();

  /// x = an approximate solution for b: linear in b and symmetric; positive if pressures are ignored.
  void cycle(const MixedVector& b, MixedVector& x);

  const ElementLevel& elements() const { return *elements_; }

 private:
  /// A mesh that was refined, and its vectors.
  struct MeshStage {
    std::unique_ptr<Layout> layout;
    std::unique_ptr<ElementLevel> level;
    std::unique_ptr<MeshTransfer> to_finer;
    MixedVector b, x, r;
  };

  /// A grid and its vectors.
  struct GridStage {
    std::unique_ptr<GridLevel> level;
    std::unique_ptr<GridTransfer> to_coarser;  // null on the coarsest
    MixedVector b, x, r;
  };

  void assemble_grids();
  void cycle_mesh(std::size_t stage, ElementLevel& level, const MixedVector& b, MixedVector& x,
                  MixedVector& r);
  void cycle_grid(std::size_t stage);

  std::unique_ptr<ElementLevel> elements_;
  std::vector<MeshStage> meshes_;
  std::vector<GridStage> grids_;
  std::unique_ptr<ElementTransfer> to_grid_;
  CoarsestLevel coarsest_;
  MixedVector residual_;
};

}  // namespace sandglass
