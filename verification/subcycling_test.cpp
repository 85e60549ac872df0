/// Small elements that take small steps alone: the averaged forces are those of a symmetric operator within
/// the stable range, so that energy is kept; momentum, frequencies, bits.

#include "solve/subcycling.hpp"

#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <numeric>

#include "base/error.hpp"
#include "mesh/refinement.hpp"
#include "solve/central_difference.hpp"
#include "solve/leapfrog.hpp"
#include "support/random_hexahedra.hpp"
#include "support/scenes.hpp"

namespace sandglass::verification {
namespace {

const NeoHookean soft{.young_modulus = 3000.0, .poisson_ratio = 0.3};

/// A bar of so many cubes of 5 cm along z, of which the first is split in eight, and its parts again: 64 small
/// elements, with their neighbours' 8 for a transition.
RefinedMesh bar(int length) {
  RefinedMesh refined(box({0.05, 0.05, 0.05 * length}, {1, 1, length}));
  for (int depth = 0; depth < 2; ++depth) {
    std::vector<bool> marked;
    for (const auto& cell : refined.mesh().cells) marked.push_back(centre_of(refined.mesh(), cell)[2] < 0.05);
    refined.split(std::move(marked));
  }
  return refined;
}

/// A moving scene on it. What is held is told by a set "held" in `description`.
Scene scene_on(const RefinedMesh& refined, Case description, const std::vector<int>& held = {}) {
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

Case moving_case(int subcycles) {
  Case description = plain_case(soft);
  description.dynamics.subcycles = subcycles;
  return description;
}

/// The derivative of a linear body's averaged forces by displacements of its free components, over the square
/// roots of their masses: M^(-1/2) K M^(-1/2), 1/s^2; and the longest stable step, s.
struct Operator {
  Eigen::MatrixXd matrix;
  double step;
  int substeps;
};

Operator operator_of(const Scene& scene) {
  const Model model(scene, {"linear"});
  const auto& elements = *std::get<std::unique_ptr<InternalForce<double>>>(model.internal_force());
  Body<double> body(model, elements);
  if (scene.description.dynamics.subcycles > 1) body.subcycle(model);
  const double given = scene.description.dynamics.time_step, stable = body.stable_step(model, given).step;
  EXPECT_LE(given, stable);
  const double step = given > 0.0 ? given : stable;
  body.set_step(step);
  std::vector<std::size_t> free;
  for (std::size_t n = 0; n < model.masses().size(); ++n)
    if (model.masses()[n] > 0.0)
      for (std::size_t i = 0; i < 3; ++i) free.push_back(3 * n + i);
  for (const Constraint& c : scene.constraints) std::erase(free, 3 * index(c.node) + index(c.component));
  const auto size = static_cast<Eigen::Index>(free.size());
  Operator found{Eigen::MatrixXd(size, size), step,
                 body.subcycling() ? body.subcycling()->substeps() : 1};
  for (std::size_t a = 0; a < free.size(); ++a) {
    NodalField u(model.masses().size());
    u[free[a] / 3][free[a] % 3] = 1.0;
    follow(scene.ties, u);
    body.state() = state_at(elements, u);
    body.evaluate_forces();
    const NodalField force = body.field(body.free_forces());
    for (std::size_t b = 0; b < free.size(); ++b) {
      found.matrix(static_cast<Eigen::Index>(b), static_cast<Eigen::Index>(a)) =
          force[free[b] / 3][free[b] % 3] / std::sqrt(model.masses()[free[a] / 3] * model.masses()[free[b] / 3]);
    }
  }
  return found;
}

Eigen::VectorXd eigenvalues_of(const Operator& found) {
  return Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(found.matrix, Eigen::EigenvaluesOnly).eigenvalues();
}

TEST(Scratch, first) {
  const RefinedMesh refined = bar(32);
  const Operator plain = operator_of(scene_on(refined, moving_case(1)));
  for (const double times : {1.05, 1.5, 2.0, 3.0, 3.2, 3.59}) {
    Case description = moving_case(16);
    description.dynamics.time_step = times * plain.step;
    const Operator cycled = operator_of(scene_on(refined, description));
    std::printf("steps %g %g substeps %d elements %zu\n", plain.step, cycled.step, cycled.substeps,
                refined.mesh().cells.size());
    std::printf("asym %g %g\n", (plain.matrix - plain.matrix.transpose()).norm() / plain.matrix.norm(),
                (cycled.matrix - cycled.matrix.transpose()).norm() / cycled.matrix.norm());
    const auto a = eigenvalues_of(plain), b = eigenvalues_of(cycled);
    std::printf("largest l dt^2/4: %g %g\n", a.maxCoeff() * plain.step * plain.step / 4,
                b.maxCoeff() * cycled.step * cycled.step / 4);
    for (Eigen::Index k = 6; k < 20; ++k) {
      const auto w = [&](double l, double dt) { return 2 / dt * std::asin(dt * std::sqrt(std::max(l, 0.0)) / 2); };
      std::printf(" %.2g", w(b[k], cycled.step) / w(a[k], plain.step) - 1);
    }
    std::printf("\n");
  }
}

}  // namespace
}  // namespace sandglass::verification
