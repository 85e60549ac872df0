#pragma once

#include "forces/dead_loads.hpp"
#include "mesh/hexahedron.hpp"
#include "support/derivatives.hpp"
#include "support/exact_stress.hpp"
#include "support/random_hexahedra.hpp"
#include "support/scenes.hpp"

/// Manufactured solutions: for a chosen displacement field, derivatives give the loads for which it is the
/// exact answer.
namespace sandglass::verification {

/// X with the slope 1 in component j.
template <class T>
Triple<Dual<T>> moving_along(const Triple<T>& X, int j) {
  Triple<Dual<T>> moving;
  for (int i = 0; i < 3; ++i) moving(i, 0) = {X(i, 0), T(i == j ? 1.0 : 0.0)};
  return moving;
}

/// H_ij = du_i/dX_j.
template <class Field, class T>
Tensor<T> field_gradient(const Field& field, const Triple<T>& X) {
  Tensor<T> H;
  for (int j = 0; j < 3; ++j) {
    const Triple<Dual<T>> u = field(moving_along(X, j));
    for (int i = 0; i < 3; ++i) H(i, j) = u(i, 0).slope;
  }
  return H;
}

/// A field and its equilibrium loads: b = -Div P in the body, t = P N on its surface. P is the stress of the
/// method's theory, the law's or that of small strains.
template <class Field>
struct ManufacturedSolution {
  Field field;
  AnyLaw law;
  bool linear = false;  ///< of small-strain theory

  /// First Piola-Kirchhoff stress, Pa.
  Tensor<double> stress(const Triple<double>& X) const {
    return exact_stress(linear, law, field_gradient(field, X));
  }

  /// N/m^3.
  Triple<double> body_force(const Triple<double>& X) const {
    Triple<double> b{};
    for (int j = 0; j < 3; ++j) {
      const Tensor<D> P = exact_stress(linear, law, field_gradient(field, moving_along(X, j)));
      for (int i = 0; i < 3; ++i) b(i, 0) -= P(i, j).slope;
    }
    return b;
  }

  Vector displacement(const Vector& X) const { return field(Triple<double>{{X[0], X[1], X[2]}}).entries; }
};

/// The Gauss rule of three points on [-1, 1]: exact to degree 5. In all three directions, it integrates loads
/// and errors up to terms of order h^6 and more.
inline constexpr std::array<double, 3> rich_points{-0.77459666924148337704, 0.0, 0.77459666924148337704};
inline constexpr std::array<double, 3> rich_weights{5.0 / 9, 8.0 / 9, 5.0 / 9};

/// A point of this rule in an element: shape functions, position (m) and weight (m^3).
struct RichPoint {
  std::array<double, 3> xi;
  Matrix<double, 8, 1> N;
  Triple<double> X;
  double weight;
};

/// Calls visit(point) for all 27 points of an element with nodes at X.
template <class Visit>
void for_rich_points(const NodalVectors<double>& X, const Visit& visit) {
  for (std::size_t p = 0; p < 27; ++p) {
    const std::array<std::size_t, 3> at{p % 3, p / 3 % 3, p / 9};
    RichPoint point{};
    for (std::size_t i = 0; i < 3; ++i) point.xi[i] = rich_points[at[i]];
    for (int I = 0; I < 8; ++I) {
      point.N(I, 0) = 0.125;
      for (int i = 0; i < 3; ++i) point.N(I, 0) *= 1.0 + corner_signs(I, i) * point.xi[index(i)];
    }
    point.X = transpose(X) * point.N;
    point.weight = rich_weights[at[0]] * rich_weights[at[1]] * rich_weights[at[2]] *
                   determinant(parent_jacobian(X, point.xi));
    visit(point);
  }
}

/// Adds the integral of N t over a face to the loads of its nodes; t(X, N) is the traction (Pa) where the
/// outward normal is N.
template <class Traction>
void add_face_loads(const NodalField& points, const Quadrilateral& face, const Traction& traction,
                    NodalField& loads) {
  constexpr std::array<std::array<double, 2>, 4> signs{{{-1, -1}, {1, -1}, {1, 1}, {-1, 1}}};
  for (std::size_t p = 0; p < 9; ++p) {
    const double xi = rich_points[p % 3], eta = rich_points[p / 3];
    std::array<double, 4> N{};
    Triple<double> X{}, along_xi{}, along_eta{};
    for (std::size_t I = 0; I < 4; ++I) {
      const auto [s, t] = signs[I];
      N[I] = 0.25 * (1 + s * xi) * (1 + t * eta);
      const Triple<double> corner{points[index(face[I])]};
      X += N[I] * corner;
      along_xi += 0.25 * s * (1 + t * eta) * corner;
      along_eta += 0.25 * t * (1 + s * xi) * corner;
    }
    const Triple<double> area = rich_weights[p % 3] * rich_weights[p / 3] * cross(along_xi, along_eta);
    const Triple<double> force = traction(X, area);
    for (std::size_t I = 0; I < 4; ++I) {
      for (int i = 0; i < 3; ++i) loads[index(face[I])][index(i)] += N[I] * force(i, 0);
    }
  }
}

/// The consistent nodal loads of a manufactured solution on the mesh, sorted by node: body force and, on the
/// whole surface, tractions. Loads on held nodes become part of their reactions.
template <class Solution>
std::vector<NodalLoad> manufactured_loads(const Mesh& mesh, const Solution& solution) {
  NodalField loads(mesh.points.size(), Vector{});
  for (const auto& cell : mesh.cells) {
    for_rich_points(gather(mesh.points, cell), [&](const RichPoint& point) {
      const Triple<double> force = point.weight * solution.body_force(point.X);
      for (int I = 0; I < 8; ++I) {
        for (int i = 0; i < 3; ++i) {
          loads[index(cell[index(I)])][index(i)] += point.N(I, 0) * force(i, 0);
        }
      }
    });
  }
  const auto traction = [&](const Triple<double>& X, const Triple<double>& area) {
    return solution.stress(X) * area;
  };
  for (const auto& face : boundary_faces(mesh.cells)) add_face_loads(mesh.points, face, traction, loads);
  std::vector<NodalLoad> result;
  for (std::size_t n = 0; n < loads.size(); ++n) result.push_back({static_cast<int>(n), loads[n]});
  return result;
}

/// The errors of a trilinear field: norms over the body, relative to those of the exact field.
struct FieldErrors {
  double displacement;  ///< L2
  double gradient;      ///< H1 seminorm
  double nodal;         ///< L2 of the trilinear field of the nodes' own errors: without interpolation
};

template <class Field>
FieldErrors field_errors(const Mesh& mesh, const NodalField& u, const Field& field) {
  double distance = 0.0, size = 0.0, gradient_distance = 0.0, gradient_size = 0.0, nodal_distance = 0.0;
  NodalField errors;
  for (std::size_t n = 0; n < u.size(); ++n) {
    const Triple<double> error = Triple<double>{u[n]} - field(Triple<double>{mesh.points[n]});
    errors.push_back(error.entries);
  }
  for (const auto& cell : mesh.cells) {
    const NodalVectors<double> X = gather(mesh.points, cell), nodal = gather(u, cell);
    const NodalVectors<double> nodal_error = gather(errors, cell);
    for_rich_points(X, [&](const RichPoint& point) {
      const Triple<double> exact = field(point.X), error = transpose(nodal) * point.N - exact;
      const Tensor<double> H = field_gradient(field, point.X);
      const Tensor<double> H_error = transpose(nodal) * point_gradient(X, point.xi).gradient - H;
      distance += point.weight * double_dot(error, error);
      const Triple<double> own = transpose(nodal_error) * point.N;
      nodal_distance += point.weight * double_dot(own, own);
      size += point.weight * double_dot(exact, exact);
      gradient_distance += point.weight * double_dot(H_error, H_error);
      gradient_size += point.weight * double_dot(H, H);
    });
  }
  return {std::sqrt(distance / size), std::sqrt(gradient_distance / gradient_size),
          std::sqrt(nodal_distance / size)};
}

/// A unit cube of n x n x n elements whose nodes are moved by up to `share` of an edge along each axis;
/// surface nodes stay on the surface. Up to 0.15 every corner of every element has a positive volume: the
/// edges there are I + E with |E_ij| <= 0.3, and det(I + E) >= 0.7^3 - 3 0.7 0.3^2 - 2 0.3^3 = 0.1.
inline Mesh distorted_cube(int n, double share, std::uint64_t seed) {
  Mesh mesh = box({1.0, 1.0, 1.0}, {n, n, n});
  RandomGeometry random(seed);
  for (auto& X : mesh.points) {
    for (double& x : X) {
      const double shift = random.uniform(-share, share) / n;
      if (x > 0.5 / n && x < 1.0 - 0.5 / n) x += shift;
    }
  }
  return mesh;
}

}  // namespace sandglass::verification
