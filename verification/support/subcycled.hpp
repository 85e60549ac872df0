#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <utility>
#include <vector>

#include "mesh/refinement.hpp"
#include "mesh/vectors.hpp"
#include "solve/leapfrog.hpp"
#include "support/scenes.hpp"

/// Scenes with small elements, and the operators of their averaged forces.
namespace sandglass::verification::subcycled {

inline const NeoHookean soft{.young_modulus = 3000.0, .poisson_ratio = 0.3};

/// Cubes of 5 cm, the one at the origin split into eight and its parts split again.
inline RefinedMesh refined_at_the_origin(const std::array<int, 3>& cubes) {
  RefinedMesh refined(box({0.05 * cubes[0], 0.05 * cubes[1], 0.05 * cubes[2]}, cubes));
  for (int depth = 0; depth < 2; ++depth) {
    std::vector<bool> marked;
    for (const auto& cell : refined.mesh().cells) {
      const Vector centre = mean_at(cell, refined.mesh().points);
      marked.push_back(*std::max_element(centre.begin(), centre.end()) < 0.05);
    }
    refined.split(std::move(marked));
  }
  return refined;
}

/// A bar of such cubes along z: 64 small elements at its end, 8 of the next size, and large ones.
inline RefinedMesh bar(int length) {
  return refined_at_the_origin({1, 1, length});
}

/// A moving scene on the refined mesh, in which some nodes are held.
inline Scene scene_on(const RefinedMesh& refined, Case description, const std::vector<int>& held = {}) {
  description.quasi_static = false;
  if (description.dynamics.duration == 0.0) description.dynamics.duration = 1.0;
  if (!held.empty()) description.displacements.push_back({"held", {}});
  Scene scene = make_scene(description, refined.mesh(), {{"held", held}});
  scene.ties = to_free_nodes(refined.ties());
  scene.coarser = refined.coarser();
  scene.boundary = refined.boundary();
  std::erase_if(scene.constraints, [&](const Constraint& c) { return is_tied(scene.ties, c.node); });
  return scene;
}

/// With at most so many small steps in a step.
inline Case moving_case(int subcycles) {
  Case description = plain_case(soft);
  description.dynamics.subcycles = subcycles;
  return description;
}

/// The derivative of a linear body's averaged forces by displacements of its free components, over the square
/// roots of their masses: M^(-1/2) K M^(-1/2), 1/s^2; and the longest stable step, s.
struct Operator {
  std::vector<double> matrix;  ///< by rows
  int size;
  double step;
  int substeps;

  /// |A - A^T| / |A|.
  double asymmetry() const {
    double difference = 0.0, norm = 0.0;
    const auto n = static_cast<std::size_t>(size);
    for (std::size_t k = 0; k < n * n; ++k) {
      const double transposed = matrix[k % n * n + k / n];
      difference += (matrix[k] - transposed) * (matrix[k] - transposed);
      norm += matrix[k] * matrix[k];
    }
    return std::sqrt(difference / norm);
  }
};

/// Of a linear body; of the longest stable step, unless the case gives one.
inline Operator operator_of(const Scene& scene) {
  const Model model(scene, {"linear"});
  const auto& elements = *std::get<std::unique_ptr<InternalForce<double>>>(model.internal_force());
  Leapfrog<double> motion(model, elements, 0.0);
  motion.subcycle(model);
  Body<double>& body = motion.body();
  const double given = scene.settings.dynamics.time_step, stable = motion.stable_step(model, given).step;
  EXPECT_LE(given, stable);
  const double step = given > 0.0 ? given : stable;
  body.set_step(step);
  std::vector<std::size_t> free;
  for (std::size_t n = 0; n < model.masses().size(); ++n)
    if (model.masses()[n] > 0.0)
      for (std::size_t i = 0; i < 3; ++i) free.push_back(3 * n + i);
  for (const Constraint& c : scene.constraints) std::erase(free, 3 * index(c.node) + index(c.component));
  const std::size_t size = free.size();
  Operator found{std::vector<double>(size * size), static_cast<int>(size), step, body.substeps()};
  for (std::size_t a = 0; a < free.size(); ++a) {
    NodalField u(model.masses().size());
    u[free[a] / 3][free[a] % 3] = 1.0;
    follow(scene.ties, u);
    body.state() = state_at(elements, u);
    body.evaluate_forces();
    const NodalField force = body.field(body.free_forces());
    for (std::size_t b = 0; b < free.size(); ++b) {
      found.matrix[b * size + a] = force[free[b] / 3][free[b] % 3] /
                                   std::sqrt(model.masses()[free[a] / 3] * model.masses()[free[b] / 3]);
    }
  }
  return found;
}

/// A case whose step is `times` the stable one without subcycling.
inline Case subcycled_case(const RefinedMesh& refined, double times) {
  Case description = moving_case(16);
  description.dynamics.time_step = times * operator_of(scene_on(refined, moving_case(1))).step;
  return description;
}

}  // namespace sandglass::verification::subcycled
