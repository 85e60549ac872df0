#pragma once

#include "mesh/mesh.hpp"

namespace sandglass {

/// The smallest det(dX/dxi) at the eight Gauss points, m^3.
double smallest_measure(const NodalVectors<double>& X);

/// Common properties of the elements of a mesh.
enum class Shapes { any, parallelepipeds };

/// Whether all elements are parallelepipeds, up to the roundoff of coordinates.
Shapes shapes_in(const Mesh& mesh);

/// Throws InputError if an element has det(dX/dxi) <= 0 at a Gauss point; the error lists the first ten with
/// number, centre and determinant.
void require_positive_jacobians(const Mesh& mesh);

}  // namespace sandglass
