#pragma once

#include <array>

#include "math/matrix.hpp"

/// The trilinear hexahedron: nodes in VTK order, faces, edges, shape functions, hourglass base vectors, mean
/// gradients; for set-up, in double precision. It is the only shape of elements; the rest of the library
/// takes the numbers of its nodes, faces and edges from here.
namespace sandglass {

/// The nodes of a hexahedron, VTK order.
using Hexahedron = std::array<int, 8>;

/// The nodes of a face, counterclockwise seen from outside.
using Quadrilateral = std::array<int, 4>;

/// Three components at each node of a hexahedron: displacements, forces, coordinates.
template <class T>
using NodalVectors = Matrix<T, 8, 3>;

/// The corners of each face, counterclockwise seen from outside.
inline constexpr std::array<std::array<std::size_t, 4>, 6> hexahedron_faces{
    {{0, 3, 2, 1}, {4, 5, 6, 7}, {0, 1, 5, 4}, {1, 2, 6, 5}, {2, 3, 7, 6}, {3, 0, 4, 7}}};

/// The corners at the ends of each edge.
inline constexpr std::array<std::array<std::size_t, 2>, 12> hexahedron_edges{
    {{0, 1}, {1, 2}, {2, 3}, {3, 0}, {4, 5}, {5, 6}, {6, 7}, {7, 4}, {0, 4}, {1, 5}, {2, 6}, {3, 7}}};

/// Parent coordinates (xi, eta, zeta) of the eight nodes, VTK order.
inline constexpr NodalVectors<double> corner_signs{{-1, -1, -1, 1, -1, -1, 1, 1, -1, -1, 1, -1,  //
                                                    -1, -1, 1,  1, -1, 1,  1, 1, 1,  -1, 1, 1}};

/// The share of an element's mass, or density, that each of its nodes carries.
constexpr double share_of_node(double of_element) {
  return of_element / 8.0;
}

/// Hourglass base vectors Gamma_Ia of Flanagan and Belytschko 1981: the nodal values of eta zeta, xi zeta, xi
/// eta and xi eta zeta.
constexpr Matrix<double, 8, 4> hourglass_base_vectors() {
  Matrix<double, 8, 4> Gamma;
  for (int I = 0; I < 8; ++I) {
    const double xi = corner_signs(I, 0);
    const double eta = corner_signs(I, 1);
    const double zeta = corner_signs(I, 2);
    Gamma(I, 0) = eta * zeta;
    Gamma(I, 1) = xi * zeta;
    Gamma(I, 2) = xi * eta;
    Gamma(I, 3) = xi * eta * zeta;
  }
  return Gamma;
}

/// Values of the trilinear shape functions at a parent point.
constexpr std::array<double, 8> shape_functions(const std::array<double, 3>& xi) {
  std::array<double, 8> N{};
  for (int I = 0; I < 8; ++I) {
    N[static_cast<std::size_t>(I)] = (1.0 + corner_signs(I, 0) * xi[0]) * (1.0 + corner_signs(I, 1) * xi[1]) *
                                     (1.0 + corner_signs(I, 2) * xi[2]) / 8.0;
  }
  return N;
}

/// dN_I/dxi_j of the trilinear shape functions at a parent point.
constexpr NodalVectors<double> parent_gradient(const std::array<double, 3>& xi) {
  NodalVectors<double> gradient;
  for (int I = 0; I < 8; ++I) {
    const double a = 1.0 + corner_signs(I, 0) * xi[0];
    const double b = 1.0 + corner_signs(I, 1) * xi[1];
    const double c = 1.0 + corner_signs(I, 2) * xi[2];
    gradient(I, 0) = corner_signs(I, 0) * b * c / 8.0;
    gradient(I, 1) = corner_signs(I, 1) * a * c / 8.0;
    gradient(I, 2) = corner_signs(I, 2) * a * b / 8.0;
  }
  return gradient;
}

/// The coordinate of the points of the 2x2x2 Gauss rule on the parent axes: 1/sqrt(3).
inline constexpr double gauss_coordinate = 0.57735026918962576451;

/// The eight points of the 2x2x2 Gauss rule, in the order of the nearest corners; every weight is 1.
constexpr std::array<std::array<double, 3>, 8> gauss_points() {
  std::array<std::array<double, 3>, 8> points{};
  for (int q = 0; q < 8; ++q) {
    for (int i = 0; i < 3; ++i)
      points[static_cast<std::size_t>(q)][static_cast<std::size_t>(i)] =
          gauss_coordinate * corner_signs(q, i);
  }
  return points;
}

/// The Jacobian dX_i/dxi_j of the map from the parent cube, in m.
constexpr Tensor<double> parent_jacobian(const NodalVectors<double>& X, const std::array<double, 3>& xi) {
  return transpose(X) * parent_gradient(xi);
}

/// Gradients dN_I/dX_i (1/m) at a parent point and the measure det(dX/dxi) (m^3) there.
struct PointGradient {
  NodalVectors<double> gradient;
  double measure;
};

/// Gradients and measure at the parent point xi of a hexahedron with corners X (m).
constexpr PointGradient point_gradient(const NodalVectors<double>& X, const std::array<double, 3>& xi) {
  const Tensor<double> jacobian = parent_jacobian(X, xi);
  return {parent_gradient(xi) * inverse(jacobian), determinant(jacobian)};
}

/// The uniform strain hexahedron: mean gradients h_Ii = B_Ii / V (1/m) and exact volume V (m^3), eq. 1 of the
/// paper.
struct MeanGradient {
  NodalVectors<double> h;
  double volume;
};

/// Mean gradients and volume of a hexahedron with corners X (m), by 2x2x2 Gauss points. The rule is exact for
/// B_Ii = integral of dN_I/dX_i and for V, because the integrands are quadratic in each parent coordinate.
/// Gradients at the centre would fail the patch test on distorted meshes.
constexpr MeanGradient mean_gradient(const NodalVectors<double>& X) {
  NodalVectors<double> B{};
  double V = 0.0;
  for (const auto& xi : gauss_points()) {
    const Tensor<double> jacobian = parent_jacobian(X, xi);
    B += parent_gradient(xi) * transpose(cofactor(jacobian));
    V += determinant(jacobian);
  }
  return {(1.0 / V) * B, V};
}

/// Hourglass shape vectors gamma_Ia = Gamma_Ia - h_Ii X_Ji Gamma_Ja (eq. 2 of the paper) of a hexahedron with
/// corners X (m) and mean gradients h (1/m). They are orthogonal to every linear field.
constexpr Matrix<double, 8, 4> hourglass_shape_vectors(const NodalVectors<double>& X,
                                                       const NodalVectors<double>& h) {
  constexpr auto Gamma = hourglass_base_vectors();
  return Gamma - h * (transpose(X) * Gamma);
}

}  // namespace sandglass
