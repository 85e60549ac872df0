#pragma once

#include <array>
#include <functional>

#include "mesh/mesh.hpp"

namespace sandglass {

/// A lattice of n[0] x n[1] x n[2] hexahedra; `place` maps lattice coordinates in [0,1]^3 to space. Nodes are
/// numbered with the first index fastest. Throws ComputationError if there is too little memory.
Mesh lattice(const std::array<int, 3>& n, const std::function<Vector(const Vector&)>& place);

}  // namespace sandglass
