#pragma once

#include "math/dual.hpp"
#include "mesh/mesh.hpp"

namespace sandglass {

/// The force at a node, N.
struct NodalLoad {
  int node;
  Vector force;
  std::size_t curve = 0;  ///< the number of its load curve in the scene
};

/// A Gauss point of a face: the shape functions of its four nodes, its position (m), and its share of the
/// area (m^2).
template <class T>
struct FacePointOf {
  std::array<double, 4> N;
  Triple<T> X;
  T area;
  Triple<T> normal;  ///< times the area
};
using FacePoint = FacePointOf<double>;

/// The 2x2 Gauss points of a bilinear face with these corners, m.
template <class T>
std::array<FacePointOf<T>, 4> gauss_points_of(const std::array<Triple<T>, 4>& corners) {
  constexpr std::array<std::array<double, 2>, 4> signs{{{-1, -1}, {1, -1}, {1, 1}, {-1, 1}}};
  const double a = 1.0 / std::sqrt(3.0);
  std::array<FacePointOf<T>, 4> result;
  for (std::size_t q = 0; q < 4; ++q) {
    const double xi = a * signs[q][0], eta = a * signs[q][1];
    Triple<T> X{}, along_xi{}, along_eta{};
    for (std::size_t I = 0; I < 4; ++I) {
      const auto [s, t] = signs[I];
      result[q].N[I] = (1.0 + s * xi) * (1.0 + t * eta) / 4.0;
      X += T(result[q].N[I]) * corners[I];
      along_xi += T(s * (1.0 + t * eta) / 4.0) * corners[I];
      along_eta += T(t * (1.0 + s * xi) / 4.0) * corners[I];
    }
    const Triple<T> normal = cross(along_xi, along_eta);
    result[q].X = X;
    result[q].normal = normal;
    result[q].area = sqrt(double_dot(normal, normal));
  }
  return result;
}
std::array<FacePoint, 4> gauss_points_of(const std::array<Vector, 4>& corners);

/// Nodal forces (N) of a pressure of 1 Pa on a bilinear face with corners x (m): minus the integral of N_I n
/// da, exact.
template <class T>
std::array<Triple<T>, 4> pressure_forces(const std::array<Triple<T>, 4>& x) {
  std::array<Triple<T>, 4> forces{};
  for (const auto& point : gauss_points_of(x)) {
    for (std::size_t I = 0; I < 4; ++I) forces[I] += T(-point.N[I]) * point.normal;
  }
  return forces;
}
std::array<Vector, 4> pressure_forces(const std::array<Vector, 4>& x);

/// Vectors at the corners of a face, interpolated by the shape functions of one of its points.
Triple<double> interpolated(const std::array<double, 4>& N, const std::array<Vector, 4>& nodal);

/// The derivatives of a number by the corners of a face: value(points) computes it from the Gauss points in
/// dual numbers.
template <class Value>
std::array<Vector, 4> slopes_by_corners(const std::array<Vector, 4>& corners, const Value& value) {
  std::array<Triple<Dual<double>>, 4> x;
  for (std::size_t I = 0; I < 4; ++I) x[I] = from_double<Dual<double>>(Triple<double>{corners[I]});
  std::array<Vector, 4> slopes;
  for (std::size_t I = 0; I < 4; ++I) {
    for (std::size_t i = 0; i < 3; ++i) {
      x[I].entries[i].slope = 1.0;
      slopes[I][i] = value(gauss_points_of(x)).slope;
      x[I].entries[i].slope = 0.0;
    }
  }
  return slopes;
}

/// The corners of a face, m.
std::array<Vector, 4> corners_of(const NodalField& points, const Quadrilateral& face);

/// Adds vectors at the corners of a face, times a factor, to a field.
void add_at_corners(double factor, const std::array<Vector, 4>& own, const Quadrilateral& face,
                    NodalField& field);

/// The faces whose four nodes all belong to a set of nodes (sorted), in their order.
std::vector<Quadrilateral> faces_within(std::vector<Quadrilateral> faces, const std::vector<int>& nodes);

/// Consistent nodal loads, sorted by node, of the traction t(X) = a + b x (X - c) over faces, where c is
/// their centroid, a = total / area, and b is such that the moment about c is `moment`. A twisting moment
/// thus acts like the stresses of torsion, a bending moment like those of bending. Integrated with 2x2 Gauss
/// points per face, exact for plane faces; sum and moment of the nodal loads are exact for all. `faces` must
/// not be empty. `total` in N, `moment` in N m.
std::vector<NodalLoad> consistent_loads(const NodalField& points, const std::vector<Quadrilateral>& faces,
                                        const Vector& total, const Vector& moment);

/// Adds the derivatives of the power of these loads at nodal velocities v (m/s) by the positions of nodes,
/// times a factor.
void add_slopes_of_loads(double factor, const NodalField& points, const std::vector<Quadrilateral>& faces,
                         const Vector& total, const Vector& moment, const NodalField& v, NodalField& slopes);

}  // namespace sandglass
