#include "mesh/ellipsoidal_cup.hpp"

#include <cmath>
#include <numbers>

#include "mesh/cylinder.hpp"

namespace sandglass {

Mesh EllipsoidalCupMesh::build() const {
  // The mesh of a flat disc, with a core of two fifths of its radius. The outer surface is its top, so it is
  // turned over: seen from inside the cup, the outer surface is below.
  constexpr double core_size = 0.35, core_bulge = 0.3;
  Mesh mesh = CylinderMesh{1.0, 1.0, core_elements, rings, layers, core_size, core_bulge}.build();
  for (Vector& point : mesh.points) {
    const auto [x, y, z] = point;
    const double depth = (1.0 - z) * thickness, a = radius + depth, c = length + depth;
    const double distance = std::hypot(x, y);
    // The eccentric angle, from the lowest point up.
    const double angle = distance * (std::numbers::pi - std::acos(rim / c));
    const double across = distance > 0.0 ? a * std::sin(angle) / distance : 0.0;
    point = {across * x, across * y, -c * std::cos(angle)};
  }
  return mesh;
}

}  // namespace sandglass
