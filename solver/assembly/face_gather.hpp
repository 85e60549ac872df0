#pragma once

#include "assembly/layout.hpp"
#include "element/modes.hpp"
#include "math/rows.hpp"

namespace sandglass {

/// The rows at the four corners of a face of the layout, one face per lane.
template <class Number, class Real>
FaceVectors<Number> gather_face_vectors(const Rows<Real>& rows, const ElementGroups& layout,
                                        std::size_t face) {
  FaceVectors<Number> corners;
  for (std::size_t c = 0; c < 4; ++c) {
    const auto x = gather<Number>(numbers_of(rows), layout.places(face, c));
    for (std::size_t i = 0; i < 3; ++i) corners(static_cast<int>(c), static_cast<int>(i)) = x[i];
  }
  return corners;
}

/// Their modes.
template <class Number, class Real>
FaceModes<Number> gather_face_modes(const Rows<Real>& rows, const ElementGroups& layout, std::size_t face) {
  return to_face_modes(gather_face_vectors<Number>(rows, layout, face));
}

/// Adds the vectors at the corners of a face, given as modes, to their rows.
template <class Number, class Real>
void scatter_face_modes(const FaceModes<Number>& modes, Real* rows, const ElementGroups& layout,
                        std::size_t face) {
  const FaceVectors<Number> corners = from_face_modes(modes);
  for (std::size_t c = 0; c < 4; ++c) {
    const int corner = static_cast<int>(c);
    scatter_add<Number>({corners(corner, 0), corners(corner, 1), corners(corner, 2)}, rows,
                        layout.places(face, c));
  }
}

/// Reference coordinates (m) as rows, spare rows included, relative to the centre of the bounding box, so
/// that single precision does not lose digits in a mesh far from the origin.
template <class Real>
Rows<Real> centred_coordinates(const NodalField& points, const Layout& layout) {
  const auto [low, high] = bounding_box(points);
  Rows<Real> rows(layout.rows());
  for (std::size_t r = 0; r < rows.size(); ++r) {
    const Vector& X = points[static_cast<std::size_t>(layout.node_of_row[r])];
    for (std::size_t i = 0; i < 3; ++i) rows[r][i] = static_cast<Real>(X[i] - 0.5 * (low[i] + high[i]));
  }
  return rows;
}

}  // namespace sandglass
