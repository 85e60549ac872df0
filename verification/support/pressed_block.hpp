#pragma once

#include <array>

#include "support/level_kernels.hpp"
#include "support/random_hexahedra.hpp"
#include "support/scenes.hpp"

/// A scene of the adaptive method.
namespace sandglass::verification {

/// A block of distorted elements, large enough for several chunks, pressed hard on part of its top.
inline CaseOnMesh pressed_block_case(double press, const std::array<int, 3>& elements = {6, 6, 8}) {
  Case description = plain_case(level_law());
  Mesh mesh = box({0.06, 0.06, 0.08}, elements);
  RandomGeometry random(3);
  const auto inner = [](double x, double size) { return x > 1e-9 && x < size - 1e-9; };
  for (auto& X : mesh.points) {
    if (!inner(X[0], 0.06) || !inner(X[1], 0.06) || !inner(X[2], 0.08)) continue;
    for (auto& x : X) x += random.uniform(-0.001, 0.001);
  }
  const NodeSets sets{
      {"foot", nodes_where(mesh.points, [](const Vector& X) { return X[2] == 0.0; })},
      {"pressed", nodes_where(mesh.points, [](const Vector& X) { return X[2] > 0.079 && X[0] < 0.025; })}};
  description.displacements = {{"foot", {}}, {"pressed", {0.0, 0.0, -press}}};
  return {description, mesh, sets};
}

inline Scene pressed_block(double press, const std::array<int, 3>& elements = {6, 6, 8}) {
  return make_scene(pressed_block_case(press, elements));
}

/// The model's elements in double precision.
inline const InternalForce<double>& elements_of(const Model& model) {
  return *std::get<0>(model.internal_force());
}

}  // namespace sandglass::verification
