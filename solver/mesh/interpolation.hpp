#pragma once

#include "mesh/mesh.hpp"

namespace sandglass {

/// A nodal field of a mesh at other points (m): each point takes the element that holds it, and the field's
/// trilinear form there. A point outside the mesh, as on the curved boundary of a finer one, takes the
/// element it is nearest to in parent coordinates, whose form is continued. Throws InputError for a point
/// that is nowhere near the mesh.
NodalField interpolate(const Mesh& mesh, const NodalField& field, const NodalField& points);

}  // namespace sandglass
