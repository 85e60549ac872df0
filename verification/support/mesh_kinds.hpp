#pragma once

#include <cmath>
#include <string_view>
#include <tuple>
#include <vector>

#include "mesh/generators.hpp"
#include "support/patch_mesh.hpp"
#include "support/scenes.hpp"

/// Small meshes of many kinds.
namespace sandglass::verification {

/// A ring of hexahedra: a strip that closes on itself.
inline Mesh ring(int n) {
  Mesh mesh;
  for (int k = 0; k < n; ++k) {
    const double angle = 2.0 * std::acos(-1.0) * k / n;
    for (const auto& [r, z] : {std::pair{1.0, 0.0}, {2.0, 0.0}, {2.0, 1.0}, {1.0, 1.0}}) {
      mesh.points.push_back({r * std::cos(angle), r * std::sin(angle), z});
    }
  }
  for (int k = 0; k < n; ++k) {
    const int a = 4 * k, b = 4 * ((k + 1) % n);
    mesh.cells.push_back({a, b, b + 1, a + 1, a + 3, b + 3, b + 2, a + 2});
  }
  for (auto& cell : mesh.cells) {
    NodalVectors<double> X = gather(mesh.points, cell);
    if (mean_gradient(X).volume < 0.0)
      cell = {cell[4], cell[5], cell[6], cell[7], cell[0], cell[1], cell[2], cell[3]};
  }
  return mesh;
}

/// A box whose edges are not at right angles, so that no entry of the mean gradients is zero.
inline Mesh sheared_box() {
  Mesh mesh = box({2, 3, 4}, {4, 5, 9});
  for (auto& [x, y, z] : mesh.points)
    std::tie(x, y, z) = std::tuple(x + 0.3 * y - 0.2 * z, y + 0.4 * x, z - 0.3 * y);
  return mesh;
}

/// Meshes of all kinds whose elements the method accepts.
inline std::vector<Mesh> meshes(std::string_view method = "tl-perturbation") {
  return {box({1, 1, 1}, {1, 1, 1}),
          box({1, 2, 9}, {3, 4, 30}),
          box({3, 2, 2.5}, {13, 11, 12}),
          sheared_box(),
          fitting_patch(method),
          ring(40),
          EllipsoidMesh{{0.10, 0.085, 0.08}, 6, 2}.build(),
          CylinderMesh{.radius = 0.05, .height = 0.1, .core_elements = 4, .rings = 3, .layers = 9}.build()};
}

}  // namespace sandglass::verification
