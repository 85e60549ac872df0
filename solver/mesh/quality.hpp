#pragma once

#include "mesh/mesh.hpp"

namespace sandglass {

/// The smallest scaled Jacobian of a hexahedron's corners: det of the three unit edge vectors; 1 for a box.
double scaled_jacobian(const NodalVectors<double>& X);

/// The smallest det(dX/dxi) at the eight Gauss points, m^3.
double smallest_measure(const NodalVectors<double>& X);

/// Throws InputError when an element has det(dX/dxi) <= 0 at a Gauss point; names the first ten with id,
/// centre, det J.
void require_positive_jacobians(const Mesh& mesh);

}  // namespace sandglass
