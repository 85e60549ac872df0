#pragma once

#include "mesh/mesh.hpp"

namespace sandglass {

/// The force at a node, N.
struct NodalLoad {
  int node;
  Vector force;
  std::size_t curve = 0;  ///< the number of its load curve in the scene
};

/// Nodal forces (N) of a pressure of 1 Pa on a bilinear face with corners x (m): minus the integral of N_I n
/// da, exact.
std::array<Vector, 4> pressure_forces(const std::array<Vector, 4>& x);

/// The derivatives by the corners x of the power of `pressure_forces` at the constant velocities w.
std::array<Vector, 4> derivatives_of_pressure_power(const std::array<Vector, 4>& x,
                                                    const std::array<Vector, 4>& w);

/// A Gauss point of a face: the shape functions of its four nodes, its position (m), and its share of the
/// area (m^2).
struct FacePoint {
  std::array<double, 4> N;
  Triple<double> X;
  double area;
  Triple<double> normal;  ///< times the area
};

/// The 2x2 Gauss points of a bilinear face with these corners, m.
std::array<FacePoint, 4> gauss_points_of(const std::array<Vector, 4>& corners);

/// The corners of a face, m.
std::array<Vector, 4> corners_of(const NodalField& points, const Quadrilateral& face);

/// The faces whose four nodes all belong to a set of nodes (sorted), in their order.
std::vector<Quadrilateral> faces_within(std::vector<Quadrilateral> faces, const std::vector<int>& nodes);

/// Consistent nodal loads, sorted by node, of the traction t(X) = a + b x (X - c) over faces, where c is
/// their centroid, a = total / area, and b is such that the moment about c is `moment`. A twisting moment
/// thus acts like the stresses of torsion, a bending moment like those of bending. Integrated with 2x2 Gauss
/// points per face, exact for plane faces; sum and moment of the nodal loads are exact for all. `faces` must
/// not be empty. `total` in N, `moment` in N m.
std::vector<NodalLoad> consistent_loads(const NodalField& points, const std::vector<Quadrilateral>& faces,
                                        const Vector& total, const Vector& moment);

}  // namespace sandglass
