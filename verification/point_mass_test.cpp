/// Masses attached to nodes: inertia, weight, and where they go with the mesh. Exact answers.

#include <gtest/gtest.h>

#include <cmath>
#include <numeric>

#include "mesh/mesh_part.hpp"
#include "problem/make_scene.hpp"
#include "solve/central_difference.hpp"
#include "solve/relaxation.hpp"
#include "support/random_hexahedra.hpp"
#include "support/scenes.hpp"

namespace sandglass::verification::point_mass_test {
namespace {

constexpr double height = 0.4, area = 0.01, density = 800.0, total = 5.0;  // the column has 3.2 kg
constexpr double of_column = density * area * height;
const NeoHookean law{.young_modulus = 3000.0, .poisson_ratio = 0.3};

double modulus() {
  return lame_lambda(law) + 2.0 * law.shear_modulus();
}

/// A column between smooth walls on a held foot, with a mass on its head: linear elements are exact.
CaseOnMesh column(const std::array<int, 3>& elements) {
  Case description = plain_case(law, density);
  const Mesh mesh = box({0.1, 0.1, height}, elements);
  const auto layer = [&](double z) {
    return nodes_where(mesh.points, [=](const Vector& X) { return std::abs(X[2] - z) < 1e-9; });
  };
  std::vector<int> all(mesh.points.size());
  std::iota(all.begin(), all.end(), 0);
  NodeSets sets{{"all", all}, {"foot", layer(0.0)}, {"head", layer(height)}};
  description.displacements = {{"all", {}, {true, true, false}}, {"foot", {}, {false, false, true}}};
  description.forces.of<PointMass>() = {{"head", total}};
  return {std::move(description), mesh, std::move(sets)};
}

double sum_of(const std::vector<double>& values) {
  return std::accumulate(values.begin(), values.end(), 0.0);
}

double weight_of(const Scene& scene) {
  double sum = 0.0;
  for (const NodalLoad& load : dead_loads(scene.forces)) sum -= load.force[2];
  return sum;
}

/// The head sinks by (m + m_column / 2) g H / (A M), M the modulus of uniaxial strain, and the foot carries
/// the whole weight. A share that differs between nodes would bend the head; a mass without weight would
/// leave a quarter of the motion.
TEST(PointMass, hangs_on_a_column_with_its_weight) {
  CaseOnMesh problem = column({1, 1, 7});
  const double g = 0.1;
  problem.description.forces.of<Gravity>() = {{{0.0, 0.0, -g}}};
  const Scene scene = make_scene(problem);
  EXPECT_NEAR(weight_of(scene), (total + of_column) * g, 1e-14);
  const Model model(scene, {"linear"});
  Observer silent;
  const Relaxation answer = relax(model, silent);
  ASSERT_TRUE(answer.converged);
  const double expected = -(total + 0.5 * of_column) * g * height / (area * modulus());
  double mean = 0.0;
  for (const int node : scene.sets.at("head")) mean += answer.u[at(node)][2] / 4.0;
  EXPECT_NEAR(mean / expected, 1.0, 1e-7);
  const NodalField internal = internal_forces(model, answer.u);
  double reaction = 0.0;
  for (const int node : scene.sets.at("foot")) reaction += internal[at(node)][2];
  for (const NodalLoad& load : dead_loads(scene.forces))
    if (scene.mesh.points[at(load.node)][2] == 0.0) reaction -= load.force[2];
  EXPECT_NEAR(reaction / ((total + of_column) * g), 1.0, 3e-8);  // the residual, 1e-8 of loads and reactions
}

/// On one element, a head of mass M = m + m_column / 2 on the stiffness k = A M / H swings with omega^2 = k /
/// M. Central differences follow it exactly at their own frequency, sin(phi / 2) = omega dt / 2. Without the
/// mass, omega would be twice as large.
TEST(PointMass, swings_with_the_period_of_a_mass_on_a_spring) {
  CaseOnMesh problem = column({1, 1, 1});
  const double omega = std::sqrt(area * modulus() / height / (total + 0.5 * of_column)), dt = 0.08 / omega;
  const double speed = 1e-6;  // so that the motion is linear to 1e-5
  Case& description = problem.description;
  description.quasi_static = false;
  description.velocities = {{.set = "head", .value = {0.0, 0.0, speed}}};
  description.dynamics = {.duration = 100 * dt, .time_step = dt, .frames = 1000};
  const Scene scene = make_scene(problem);
  const double phi = 2.0 * std::asin(0.5 * omega * dt);
  for (const char* method : {"tl-mean-dilatation", "tl-perturbation", "tl-full"}) {
    Recorder recorder;
    integrate(Model(scene, {method}), recorder);
    ASSERT_GE(recorder.frames.size(), 100U);
    for (const Frame& frame : recorder.frames) {
      const double n = std::round(frame.time / dt), u = speed * dt * std::sin(n * phi) / std::sin(phi);
      for (const int node : scene.sets.at("head"))
        EXPECT_NEAR(frame.u[at(node)][2], u, 1e-4 * speed / omega) << method << " step " << n;
    }
  }
}

/// A part of the mesh keeps the masses of its nodes, and hanging nodes hand theirs on, so that nothing is
/// lost; a spinning set turns about its centre of mass, which is that of both masses.
TEST(PointMass, goes_with_the_nodes) {
  CaseOnMesh problem = column({2, 2, 4});
  const Scene whole = make_scene(problem);
  EXPECT_NEAR(sum_of(whole.attached_masses), total, 1e-14);
  EXPECT_NEAR(sum_of(Model(whole, {"tl-full"}).masses()), total + of_column, 1e-14);
  std::vector<bool> upper(whole.mesh.cells.size());
  for (std::size_t e = 0; e < upper.size(); ++e)
    upper[e] = mean_at(whole.mesh.cells[e], whole.mesh.points)[2] > 0.5 * height;
  const Scene part = on_part(whole, part_of_mesh(whole.mesh, upper));
  EXPECT_NEAR(sum_of(Model(part, {"tl-full"}).masses()), total + 0.5 * of_column, 1e-14);
  problem.description.refinements = {{.numbers = {15}}};
  const Scene refined = make_scene(problem);
  ASSERT_FALSE(refined.ties.empty());
  EXPECT_NEAR(sum_of(Model(refined, {"tl-full"}).masses()), total + of_column, 1e-14);
  EXPECT_NEAR(sum_of(refined.attached_masses), total, 1e-14);
}

TEST(PointMass, is_part_of_the_case) {
  CaseOnMesh problem = column({1, 1, 1});
  const std::string hash = case_hash(problem.description);
  problem.description.forces.of<PointMass>()[0].total = 4.0;
  EXPECT_NE(case_hash(problem.description), hash);
  problem.description.forces.of<PointMass>()[0].set = "nose";
  EXPECT_THROW(make_scene(problem), InputError);
}

}  // namespace
}  // namespace sandglass::verification::point_mass_test
