#pragma once

#include "mesh/refinement.hpp"
#include "multigrid/element_level.hpp"

namespace sandglass {

/// Transfers residuals and corrections between a refined mesh and the mesh whose elements were split.
/// Displacements are interpolated from the coarser mesh; parts have the pressures of their elements.
class MeshTransfer {
 public:
  /// Both levels must live as long.
  MeshTransfer(const CoarserMesh& coarser_mesh, const Layout& fine_layout, const ElementLevel& fine,
               const Layout& coarse_layout, const ElementLevel& coarse);

  /// Displacements (m) of the coarser mesh from the finer one's, at their common nodes.
  Rows<float> at_common_nodes(const Rows<float>& fine) const;

  /// The mean over the parts of each element of the coarser mesh, by cell; 1 in empty cells.
  std::vector<float> means(const std::vector<float>& fine) const;

  /// b = the residual r of the finer mesh for the coarser one.
  void restrict_residual(const MixedVector& r, MixedVector& b) const;

  /// Adds the correction x of the coarser mesh to the unknowns of the finer one.
  void add_correction(const MixedVector& x, MixedVector& fine) const;

 private:
  /// A matrix by its rows.
  struct Weights {
    std::vector<std::size_t> first{0};
    std::vector<std::pair<std::uint32_t, float>> shares;
  };

  static Weights weights(const std::vector<std::vector<std::pair<std::uint32_t, float>>>& rows);

  const ElementLevel& fine_;
  const ElementLevel& coarse_;
  Weights from_coarse_, from_fine_;
  std::vector<std::uint32_t> common_;                           // the fine row of each coarse one
  std::vector<std::pair<std::uint32_t, std::uint32_t>> cells_;  // fine, coarse
};

}  // namespace sandglass
