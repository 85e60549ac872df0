#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "mesh/mesh.hpp"

namespace sandglass {

/// A grid of boxes around a mesh, with trilinear functions between its nodes. Nodes and boxes are numbered
/// with a layer of unused ones around them, so that every neighbour has a number.
struct Grid {
  Vector low{};
  Vector size{};  ///< of a box, m
  std::array<std::size_t, 3> boxes{1, 1, 1};

  /// Boxes at least twice as wide as the elements of a mesh are on average along each axis, but no narrower
  /// than twice the narrowest of the three.
  static Grid around(const Mesh& mesh);

  /// Half as many boxes along the axes along which they are narrow, as given by `halved`.
  Grid coarser(std::array<bool, 3>& halved) const;

  std::size_t stride(std::size_t axis) const {
    return axis == 0 ? 1 : axis == 1 ? boxes[0] + 3 : (boxes[0] + 3) * (boxes[1] + 3);
  }
  std::size_t nodes() const { return (boxes[0] + 3) * (boxes[1] + 3) * (boxes[2] + 3); }
  std::size_t real_nodes() const { return (boxes[0] + 1) * (boxes[1] + 1) * (boxes[2] + 1); }

  /// The number of a node; a box has the number of its lowest node.
  std::size_t number(std::size_t i, std::size_t j, std::size_t k) const {
    return (i + 1) + (j + 1) * stride(1) + (k + 1) * stride(2);
  }

  /// The offset from a box's number to its corner, 0 to 7, x varying fastest.
  std::size_t corner(std::size_t c) const {
    return (c & 1) + (c >> 1 & 1) * stride(1) + (c >> 2) * stride(2);
  }

  /// A position: a box, and coordinates from 0 to 1 within it.
  struct Location {
    std::size_t box;
    std::array<float, 3> local;
  };

  /// The location of a point (m).
  Location locate(const Vector& point) const;
};

/// The extent of an element's bounding box, m.
Vector extent(const Mesh& mesh, const Hexahedron& cell);

/// The functions of a box's corners at a position in it.
std::array<float, 8> weights(const std::array<float, 3>& local);

}  // namespace sandglass
