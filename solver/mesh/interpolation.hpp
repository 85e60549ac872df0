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

/// A straight line for an edge of a mesh, or a point for a node.
struct LineWithin {
  std::array<int, 2> nodes;  ///< twice the same for a point
  Vector from, to;           ///< m
};

/// Points for some nodes, the given share of the way from each to the middle of one of its elements.
std::vector<LineWithin> points_within(const NodalField& points, std::span<const Hexahedron> cells,
                                      std::span<const int> nodes, double share);

/// The edges between these nodes, moved by the given share of the way to the middle of one of their elements;
/// ends on the boundary are moved inwards along the edge, too.
std::vector<LineWithin> edges_within(const NodalField& points, std::span<const Hexahedron> cells,
                                     std::span<const int> nodes, double share);

/// The lines that are partly within elements that do not have their nodes, with each of these: there the mesh
/// overlaps itself.
std::vector<std::pair<LineWithin, std::size_t>> overlaps(const NodalField& points,
                                                         std::span<const Hexahedron> cells,
                                                         const std::vector<LineWithin>& lines);

/// These of both kinds, by a share of the way from points and one from edges.
std::vector<std::pair<LineWithin, std::size_t>> overlaps(const NodalField& points,
                                                         std::span<const Hexahedron> cells,
                                                         std::span<const int> nodes, double from_points,
                                                         double from_edges);

}  // namespace sandglass
