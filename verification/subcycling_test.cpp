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


Eigen::VectorXd frequencies(const Operator& found) {
  return (found.step / 2 * eigenvalues_of(found).cwiseMax(0.0).cwiseSqrt()).array().asin() * 2 / found.step;
}

TEST(Subcycling, averaged_forces_are_of_a_symmetric_operator_in_the_stable_range) {
  const RefinedMesh refined = bar(6);
  const double small_step = operator_of(scene_on(refined, moving_case(1))).step;
  std::vector<int> counts;
  for (double times = 1.05; times < 3.6; times += 0.05) {
    Case description = moving_case(16);
    description.dynamics.time_step = times * small_step;
    const Operator found = operator_of(scene_on(refined, description));
    counts.push_back(found.substeps);
    EXPECT_LT((found.matrix - found.matrix.transpose()).norm(), 1e-14 * found.matrix.norm());
    const Eigen::VectorXd squares = found.step * found.step * eigenvalues_of(found);
    EXPECT_GT(squares.minCoeff(), -1e-12);
    EXPECT_LT(squares.maxCoeff(), 4.0) << found.substeps << " in " << times;
    std::printf("%g %d %g\n", times, found.substeps, squares.maxCoeff() / 4);
  }
  EXPECT_EQ(counts.front(), 2);
  EXPECT_EQ(counts.back(), 4);
}

TEST(Subcycling, keeps_the_first_frequencies) {
  const RefinedMesh refined = bar(32);
  const Operator plain = operator_of(scene_on(refined, moving_case(1)));
  Case description = moving_case(16);
  description.dynamics.time_step = 3.59 * plain.step;
  const Operator cycled = operator_of(scene_on(refined, description));
  const Eigen::VectorXd exact = frequencies(plain), found = frequencies(cycled);
  for (Eigen::Index k = 6; k < 20; ++k) EXPECT_NEAR(found[k], exact[k], 1e-3 * exact[k]) << k;
}

/// Leapfrog's own energy.
TEST(Subcycling, keeps_energy_over_a_hundred_thousand_steps) {
  const RefinedMesh refined = bar(6);
  const auto held = nodes_where(refined.mesh().points, [](const Vector& X) { return X[2] > 0.299; });
  const double small_step = operator_of(scene_on(refined, moving_case(1), held)).step;
  for (const double times : {2.0, 3.59}) {
    Case description = moving_case(16);
    description.dynamics.time_step = times * small_step;
    const Scene scene = scene_on(refined, description, held);
    const Model model(scene, {"linear"});
    Leapfrog<double> motion(model, *std::get<std::unique_ptr<InternalForce<double>>>(model.internal_force()), 0.0);
    Body<double>& body = motion.body();
    body.subcycle(model);
    const double step = description.dynamics.time_step;
    EXPECT_LE(step, body.stable_step(model, step).step);
    body.set_step(step);
    body.evaluate_forces();
    RandomGeometry random(3);
    NodalField v(model.masses().size());
    for (Vector& at : v)
      for (double& x : at) x = random.uniform(-1e-3, 1e-3);
    follow(scene.ties, v);
    motion.set_initial_velocities(v);
    const auto energy = [&] {
      double sum = 0.0;
      const Layout& layout = body.layout();
      for (std::size_t r = 0; r < layout.nodes; ++r) {
        const double mass = model.masses()[index(layout.node_of_row[r])];
        for (std::size_t i = 0; i < 3; ++i) {
          const double du = body.state().increment[r][i], u = body.state().u[r][i] - du;
          sum += 0.5 * mass * (du / step) * (du / step) + 0.5 * u * body.free_forces()[r][i];
        }
      }
      return sum;
    };
    double start = 0.0, largest = 0.0;
    for (int n = 1; n <= 100000; ++n) {
      motion.advance(step, [](Body<double>& b) { b.impose(0.0); });
      if (n == 1) start = energy();
      if (n % 100 == 0) largest = std::max(largest, std::abs(energy() - start));
    }
    std::printf("energy %g changes %g\n", start, largest / start);
    EXPECT_LT(largest, 1e-9 * start);
  }
}

TEST(Subcycling, nonlinear) {
  const RefinedMesh refined = bar(6);
  const double small_step = operator_of(scene_on(refined, moving_case(1))).step;
  for (const double speed : {0.01, 0.1, 0.3}) for (const int subcycles : {1, 16}) {
    Case description = moving_case(subcycles);
    if (subcycles > 1) description.dynamics.time_step = 3.2 * small_step;
    else description.dynamics.time_step = 0.8 * small_step;
    description.velocities = {{.value = {0.3 * speed, 0.1 * speed, 0.0}},
                              {.value = {0.0, 0.5 * speed, speed}, .half_waves = {1, 0, 2}},
                              {.spin = {0.1, 0.0, 0.5}}};
    description.dynamics.duration = 100000 * description.dynamics.time_step;
    description.dynamics.check_interval = 20;
    const Scene scene = scene_on(refined, description);
    const Model model(scene, {"tl-perturbation"});
    Recorder recorder;
    try { integrate(model, recorder); } catch (const std::exception& e) { std::printf("%s\n", e.what()); }
    const auto& rows = recorder.rows;
    std::printf("speed %g sub %d rows %zu: ", speed, subcycles, rows.size());
    for (std::size_t part = 0; part < 10; ++part) {
      double low = 1e9, high = 0, mean = 0;
      for (std::size_t n = part * rows.size() / 10; n < (part + 1) * rows.size() / 10; ++n) {
        low = std::min(low, total_energy(rows[n])), high = std::max(high, total_energy(rows[n]));
        mean += total_energy(rows[n]) / (rows.size() / 10);
      }
      std::printf(" %.6g[%.3g %.3g]", mean, low, high);
    }
    std::printf("\n");
    Vector p{}, p0{};
    for (std::size_t n = 0; n < model.masses().size(); ++n) for (std::size_t i = 0; i < 3; ++i) {
      p[i] += model.masses()[n] * recorder.frames.back().v[n][i];
      p0[i] += model.masses()[n] * recorder.frames.front().v[n][i];
    }
    std::printf("momentum change %g\n", distance(p, p0) / length(p0));
  }
}

}  // namespace
}  // namespace sandglass::verification
