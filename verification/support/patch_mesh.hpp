#pragma once

#include "support/scenes.hpp"

namespace sandglass::verification {

/// The patch of MacNeal and Harder 1985: seven distorted hexahedra in the unit cube. Nodes 0 to 7 are the
/// inner ones, 8 to 15 the corners of the cube, both in VTK order.
inline Mesh macneal_harder_patch() {
  Mesh mesh;
  mesh.points = {{.249, .342, .192}, {.826, .288, .288}, {.850, .649, .263}, {.273, .750, .230},
                 {.320, .186, .643}, {.677, .305, .683}, {.788, .693, .644}, {.165, .745, .702},
                 {0, 0, 0},          {1, 0, 0},          {1, 1, 0},          {0, 1, 0},
                 {0, 0, 1},          {1, 0, 1},          {1, 1, 1},          {0, 1, 1}};
  mesh.cells = {{0, 1, 2, 3, 4, 5, 6, 7}};
  constexpr int faces[6][4] = {{0, 3, 2, 1}, {4, 5, 6, 7}, {0, 1, 5, 4},
                               {1, 2, 6, 5}, {2, 3, 7, 6}, {3, 0, 4, 7}};
  for (const auto& [a, b, c, d] : faces) mesh.cells.push_back({a, b, c, d, a + 8, b + 8, c + 8, d + 8});
  return mesh;
}

inline constexpr int first_corner = 8;

/// The same with inner nodes moved towards a regular patch, by as many quarters of the distance as the kernel
/// requires: none for hexahedra; but one corner of the patch has edges that span a negative volume, which
/// tetrahedra cannot have.
template <class Kernel>
Mesh fitting_patch() {
  Mesh mesh = macneal_harder_patch();
  const NodalField distorted = mesh.points;
  const auto accepted = [&](const Hexahedron& cell) { return Kernel::accepts(gather(mesh.points, cell)); };
  for (double share = 0.25; !std::ranges::all_of(mesh.cells, accepted); share += 0.25) {
    for (int n = 0; n < first_corner; ++n) {
      for (int i = 0; i < 3; ++i) {
        const double regular = 0.5 + 0.25 * corner_signs(n, i);
        double& x = mesh.points[index(n)][index(i)];
        x = distorted[index(n)][index(i)] + share * (regular - distorted[index(n)][index(i)]);
      }
    }
  }
  return mesh;
}

/// A patch with u = H X imposed on its corners.
inline Scene patch_scene(const AnyLaw& law, const Tensor<double>& H, const Mesh& mesh) {
  Case description = plain_case(law);
  NodeSets sets;
  std::vector<int> corners;
  for (int n = first_corner; n < first_corner + 8; ++n) corners.push_back(n);
  impose_field(
      corners, mesh.points, [&](const Vector& X) { return linear(H, X); }, description, sets);
  return make_scene(description, mesh, sets);
}

/// The published boundary field, grad u of 1e-3 (x + (y+z)/2, y + (x+z)/2, z + (x+y)/2), times `factor`.
inline Tensor<double> macneal_harder_gradient(double factor = 1.0) {
  const double a = 1e-3 * factor;
  return {{a, a / 2, a / 2, a / 2, a, a / 2, a / 2, a / 2, a}};
}

}  // namespace sandglass::verification
