#pragma once

#include "element/modes.hpp"
#include "math/rows.hpp"
#include "mesh/layout.hpp"

namespace sandglass {

/// The modes of a face of the layout from the rows at its four corners, one face per lane.
template <class Number, class Real>
FaceModes<Number> gather_face_modes(const Rows<Real>& rows, const Layout& layout, std::size_t face) {
  FaceVectors<Number> corners;
  for (std::size_t c = 0; c < 4; ++c) {
    const auto x = gather<Number>(numbers_of(rows), layout.places(face, c));
    for (std::size_t i = 0; i < 3; ++i) corners(static_cast<int>(c), static_cast<int>(i)) = x[i];
  }
  return to_face_modes(corners);
}

/// Reference coordinates (m) as rows, spare rows included. They are seen from the middle of the mesh: where
/// it stands must not cost single precision its digits.
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
