#pragma once

#include <string>
#include <utility>

#include "choice/candidates.hpp"
#include "support/scenes.hpp"

/// A case for the choice of a method and mesh.
namespace sandglass::verification {

/// The nodes where a coordinate has the value `at`.
inline NodeSetRule plane(const std::string& name, std::size_t axis, double at) {
  NodeSetRule rule{.name = name};
  rule.within[axis] = Interval{at, at};
  return rule;
}

/// A cantilever along x whose end is moved sideways.
inline Case cantilever(double sideways) {
  Case description = plain_case(NeoHookean{.young_modulus = 3000.0, .poisson_ratio = 0.49});
  description.mesh = BoxMesh{{1.0, 0.2, 0.2}, {8, 2, 2}};
  description.sets = {plane("foot", 0, 0.0), plane("head", 0, 1.0)};
  description.displacements = {{"foot", {}}, {"head", {0.0, 0.0, sideways}}};
  return description;
}

inline Scene scene_of_case(const Case& description) {
  return make_scene(with_mesh(description));
}

/// The user's own mesh as a mesh of candidates.
inline CandidateMesh own_mesh(const Case& description, Displacements reference = {}) {
  return {{}, with_mesh(description), scene_of_case(description), std::move(reference)};
}

}  // namespace sandglass::verification
