#pragma once

#include "mesh/mesh.hpp"

namespace sandglass {

/// The force at a node, N.
struct NodalLoad {
  int node;
  Vector force;
};

/// The boundary faces whose four nodes all belong to a set of nodes (sorted), in the order of the cells.
std::vector<Quadrilateral> faces_within(const Mesh& mesh, const std::vector<int>& nodes);

/// Consistent nodal loads, sorted by node, of the traction t(X) = a + b x (X - c) over faces, where c is
/// their centroid, a = total / area, and b is such that the moment about c is `moment`. A twisting moment
/// thus acts like the stresses of torsion, a bending moment like those of bending. Integrated with 2x2 Gauss
/// points per face, exact for plane faces; sum and moment of the nodal loads are exact for all. `faces` must
/// not be empty. `total` in N, `moment` in N m.
std::vector<NodalLoad> consistent_loads(const NodalField& points, const std::vector<Quadrilateral>& faces,
                                        const Vector& total, const Vector& moment);

}  // namespace sandglass
