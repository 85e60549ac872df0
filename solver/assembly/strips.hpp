#pragma once

#include <span>

#include "mesh/node_elements.hpp"

namespace sandglass {

/// Hexahedra in a row, each sharing a face with the next: element k is between faces k and k + 1. Along a
/// strip the four nodes of every face are loaded once instead of twice.
struct Strip {
  std::vector<Quadrilateral> faces;  ///< one more than elements; corners in the same order on each
  std::vector<int> elements;

  std::size_t length() const { return elements.size(); }
};

/// The nodes of element k of a strip in VTK order: the two faces that bound it.
Hexahedron cell_between(const Quadrilateral& lower, const Quadrilateral& upper);

/// Divides `elements` into strips. Each strip is the longest of the three through its first element that the
/// remaining elements allow; every conforming mesh of hexahedra has such rows, structured or not.
std::vector<Strip> cut_into_strips(const Mesh& mesh, const NodeElements& neighbours,
                                   std::span<const int> elements);

}  // namespace sandglass
