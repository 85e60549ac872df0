#pragma once

#include <array>
#include <vector>

#include "mesh/mesh.hpp"

namespace sandglass {

/// A grid of a few boxes around a mesh, with trilinear functions between its nodes: the coarse displacements
/// of a preconditioner.
class CoarseGrid {
 public:
  /// Boxes are as nearly cubic as the mesh allows. There is one grid node per hundred nodes of the mesh, but
  /// at least 64 if the mesh has eight times as many nodes, and at most 125, so that solving for them is
  /// cheaper than an evaluation of the forces.
  explicit CoarseGrid(const NodalField& points);

  /// A place in the grid.
  struct Location {
    std::size_t box;
    std::array<double, 3> local;  ///< 0 to 1 within the box
  };

  /// The location of a point (m) of the mesh.
  Location locate(const Vector& point) const;

  /// Size of a box, m.
  const Vector& box_size() const { return size_; }

  std::size_t boxes() const { return count(0) * count(1) * count(2); }
  std::size_t nodes() const { return (count(0) + 1) * (count(1) + 1) * (count(2) + 1); }

  /// The nodes of a box, x varying fastest, then y, then z.
  std::array<std::size_t, 8> nodes_of(std::size_t box) const;

  /// The functions of a box's nodes at a point in it.
  static std::array<double, 8> weights(const std::array<double, 3>& local);

  /// Their gradients, 1/m.
  std::array<Vector, 8> gradients(const std::array<double, 3>& local) const;

 private:
  std::size_t count(std::size_t i) const { return static_cast<std::size_t>(counts_[i]); }

  Vector low_{};
  Vector size_{};
  std::array<int, 3> counts_{1, 1, 1};
};

}  // namespace sandglass
