#pragma once

#include "base/error.hpp"
#include "support/random_hexahedra.hpp"
#include "support/scenes.hpp"

namespace sandglass::verification {

/// Whether a method accepts the elements of a mesh.
inline bool accepts(std::string_view method, const Mesh& mesh) {
  try {
    make_internal_force(mesh, sample_law<NeoHookean>(0.45), {.method = std::string(method)});
    return true;
  } catch (const InputError&) {
    return false;
  }
}

/// Coordinates of a random element that a method accepts.
inline NodalVectors<double> fitting_hexahedron(RandomGeometry& random, std::string_view method) {
  for (;;) {
    const NodalVectors<double> X = random.hexahedron();
    if (accepts(method, one_strained_element(X, {}).first)) return X;
  }
}

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

/// The same with inner nodes moved towards a regular patch, by as many quarters of the distance as the method
/// requires: none for hexahedra; but one corner of the patch has edges that span a negative volume, which
/// tetrahedra cannot have.
inline Mesh fitting_patch(std::string_view method) {
  Mesh mesh = macneal_harder_patch();
  const NodalField distorted = mesh.points;
  for (double share = 0.25; !accepts(method, mesh); share += 0.25) {
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
