#pragma once

#include <array>

#include "support/scenes.hpp"

namespace sandglass::verification {

/// A block between two plates, one of which moves; `elements` along the axes. With enough of them along z it
/// is divided among threads and ranks.
inline CaseOnMesh block_between_plates(Case description, bool quasi_static,
                                       const std::array<int, 3>& elements) {
  const Mesh mesh = box({0.1, 0.1, 0.4}, elements);
  const auto where = [&](const auto& holds) { return nodes_where(mesh.points, holds); };
  const NodeSets sets{{"foot", where([](const Vector& X) { return X[2] == 0.0; })},
                      {"head", where([](const Vector& X) { return X[2] > 0.3999; })},
                      {"side", where([](const Vector& X) { return X[0] == 0.0; })}};
  description.displacements = {{"foot", {}}, {"head", {0.01, 0.0, 0.02}}};
  description.quasi_static = quasi_static;
  description.relaxation.check_interval = 4;
  description.dynamics.duration = 0.01;
  description.dynamics.check_interval = 4;
  description.dynamics.frames = 2;
  return {std::move(description), mesh, sets};
}

}  // namespace sandglass::verification
