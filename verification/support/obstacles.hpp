#pragma once

#include "support/scenes.hpp"

/// Bodies and obstacles of tests.
namespace sandglass::verification {

/// Nodes where a coordinate has a value.
inline std::vector<int> plane(const NodalField& points, std::size_t axis, double at) {
  return nodes_where(points, [=](const Vector& X) { return std::abs(X[axis] - at) < 1e-9; });
}

/// A plane through the height z that faces the body below it, and moves.
inline Obstacle ceiling(double z, double down) {
  Obstacle made{.label = "plate", .set = "top", .point = {0.0, 0.0, z}, .normal = {0.0, 0.0, -2.0}};
  made.displacement = {0.0, 0.0, -down};
  made.penalty = 1.0;
  made.method = Obstacle::Method::penalty;
  return made;
}

/// A plane through z = 0 that faces the body above it.
inline Obstacle ground() {
  Obstacle made{.label = "ground", .set = "foot", .normal = {0.0, 0.0, 1.0}};
  made.penalty = 1.0;
  made.method = Obstacle::Method::penalty;
  return made;
}

/// The surface of a box with its centre at the origin: two triangles on each side, as the text of an .obj
/// file.
inline std::string box_surface(const Vector& half_sizes) {
  std::string text = "# a box\n";
  for (int corner = 0; corner < 8; ++corner) {
    text +=
        fmt::format("v {} {} {}\n", corner & 1 ? half_sizes[0] : -half_sizes[0],
                    corner & 2 ? half_sizes[1] : -half_sizes[1], corner & 4 ? half_sizes[2] : -half_sizes[2]);
  }
  return text + "f 1 3 4 2\nf 5/1 6/1 8/1 7/1\nf 1 2 6\nf 1 6 5\nf 3 7 8 4\nf 1 5 7 3\nf -7 -5 -1\nf 2 8 6\n";
}

/// A column on a fixed foot.
struct Column {
  Mesh mesh;
  NodeSets sets;
  Case description;

  Column(const std::array<double, 3>& size, const std::array<int, 3>& elements, const AnyLaw& law)
      : mesh(box(size, elements)),
        sets{{"foot", plane(mesh.points, 2, 0.0)},
             {"side", plane(mesh.points, 0, 0.0)},
             {"back", plane(mesh.points, 1, 0.0)},
             {"top", plane(mesh.points, 2, size[2])}},
        description(plain_case(law)) {}

  Scene scene() const { return make_scene(description, mesh, sets); }
};

}  // namespace sandglass::verification
