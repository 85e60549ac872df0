#pragma once

#include "mesh/mesh.hpp"

namespace sandglass {

/// A nodal field of a mesh at other points (m), interpolated trilinearly in the element that contains each
/// point. For a point outside the mesh, as on the curved boundary of a finer one, the field is extrapolated
/// from the element that is nearest in parent coordinates. Throws InputError for a point that is far from the
/// mesh.
NodalField interpolate(const Mesh& mesh, const NodalField& field, const NodalField& points);

}  // namespace sandglass
