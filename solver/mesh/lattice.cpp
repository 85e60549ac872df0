#include "mesh/lattice.hpp"

#include "base/memory.hpp"

namespace sandglass {

Mesh lattice(const std::array<int, 3>& n, const std::function<Vector(const Vector&)>& place) {
  require_memory(1.0 * n[0] * n[1] * n[2], MeshUse::storing);
  Mesh mesh;
  for (int k = 0; k <= n[2]; ++k) {
    for (int j = 0; j <= n[1]; ++j) {
      for (int i = 0; i <= n[0]; ++i) {
        mesh.points.push_back(place(
            {static_cast<double>(i) / n[0], static_cast<double>(j) / n[1], static_cast<double>(k) / n[2]}));
      }
    }
  }
  const auto node = [&](int i, int j, int k) { return i + (n[0] + 1) * (j + (n[1] + 1) * k); };
  for (int k = 0; k < n[2]; ++k) {
    for (int j = 0; j < n[1]; ++j) {
      for (int i = 0; i < n[0]; ++i) {
        mesh.cells.push_back({node(i, j, k), node(i + 1, j, k), node(i + 1, j + 1, k), node(i, j + 1, k),
                              node(i, j, k + 1), node(i + 1, j, k + 1), node(i + 1, j + 1, k + 1),
                              node(i, j + 1, k + 1)});
      }
    }
  }
  return mesh;
}

}  // namespace sandglass
