#pragma once

#include <span>
#include <utility>

#include "mesh/mesh.hpp"

namespace sandglass {

/// A point of an element.
struct ElementPoint {
  std::size_t element;
  Vector parent;  ///< in the element's parent coordinates
};

/// The distance of a parent point from the centre in the maximum norm; at most 1 inside the element.
double parent_distance(const Vector& xi);

/// The element that contains each point (m), or for a point outside the mesh the closest one in parent
/// coordinates. Throws InputError for a point that is far from the mesh.
std::vector<ElementPoint> element_points(const Mesh& mesh, const NodalField& points);

/// A nodal field of a mesh at other points (m), interpolated trilinearly in the element that contains each
/// point. For a point outside the mesh, as on the curved boundary of a finer one, the field is extrapolated
/// from the closest element in parent coordinates. Throws InputError for a point that is far from the mesh.
NodalField interpolate(const Mesh& mesh, const NodalField& field, const NodalField& points);

/// A point (m) within an element of a node.
struct PointWithin {
  int node;
  std::size_t element;
  Vector X;
};

/// Points for some nodes, the given share of the way from each to the middle of one of its elements.
std::vector<PointWithin> points_within(const NodalField& points, std::span<const Hexahedron> cells,
                                       std::span<const int> nodes, double share);

/// The same for places on the edges between these nodes: the middles of some equal parts of each edge.
std::vector<PointWithin> points_along_edges(const NodalField& points, std::span<const Hexahedron> cells,
                                            std::span<const int> nodes, double share);

/// The points that are also within other elements, with each of these: there the mesh overlaps itself.
std::vector<std::pair<PointWithin, std::size_t>> overlaps(const NodalField& points,
                                                          std::span<const Hexahedron> cells,
                                                          const std::vector<PointWithin>& some);

}  // namespace sandglass
