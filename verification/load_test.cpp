/// Imposed forces: consistent nodal loads, exact answers under them, work and momentum.

#include <gtest/gtest.h>

#include "math/strain.hpp"
#include "mesh/face_load.hpp"
#include "solve/body.hpp"
#include "solve/central_difference.hpp"
#include "solve/relaxation.hpp"
#include "solve/stable_step.hpp"
#include "support/pair_test.hpp"
#include "support/random_hexahedra.hpp"
#include "support/scenes.hpp"
#include "support/temporary_folder.hpp"

namespace sandglass::verification::load_test {
namespace {

Vector cross_product(const Vector& a, const Vector& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

/// Sum of nodal loads.
Vector sum_of(const std::vector<NodalLoad>& loads) {
  Vector sum{};
  for (const auto& load : loads) {
    for (std::size_t i = 0; i < 3; ++i) sum[i] += load.force[i];
  }
  return sum;
}

/// Moment of nodal loads about a point.
Vector moment_of(const std::vector<NodalLoad>& loads, const NodalField& points, const Vector& c) {
  Vector sum{};
  for (const auto& load : loads) {
    const Vector& X = points[index(load.node)];
    const Vector m = cross_product({X[0] - c[0], X[1] - c[1], X[2] - c[2]}, load.force);
    for (std::size_t i = 0; i < 3; ++i) sum[i] += m[i];
  }
  return sum;
}

void expect_near(const Vector& a, const Vector& b, double tolerance) {
  for (std::size_t i = 0; i < 3; ++i) EXPECT_NEAR(a[i], b[i], tolerance);
}

/// Uniform traction on a trapezoid with parallel edges a and b at distance h: a node of edge a carries h (2 a
/// + b) / 12 of it, the integral of its bilinear function. One Gauss point or equal shares would give h (a +
/// b) / 8 for every node.
TEST(FaceLoad, trapezoid_is_shared_out_exactly) {
  const double a = 3.0, b = 1.0, h = 2.0;
  const NodalField points{{0, 0, 0}, {a, 0, 0}, {0.5 + b, h, 0}, {0.5, h, 0}};
  const double area = h * (a + b) / 2;
  const auto loads = consistent_loads(points, {{0, 1, 2, 3}}, {0.0, area, -2.0 * area}, {});
  ASSERT_EQ(loads.size(), 4U);
  for (const auto& [node, force, curve] : loads) {
    const double share = node < 2 ? h * (2 * a + b) / 12 : h * (a + 2 * b) / 12;
    expect_near(force, {0.0, share, -2.0 * share}, 1e-15 * area);
  }
}

/// A moment about the normal of a square twists it; one about its middle line bends it: with edges of 2 c the
/// traction is b z, and a corner carries the integral of (1 + z/c)/4 b z, which is b c^3 / 3 = M / (4 c).
TEST(FaceLoad, moments_act_like_twisting_and_bending_stresses) {
  const double c = 0.5, M = 1.7;
  const NodalField points{{3, -c, -c}, {3, c, -c}, {3, c, c}, {3, -c, c}};
  for (const auto& [node, force, curve] : consistent_loads(points, {{0, 1, 2, 3}}, {}, {0.0, M, 0.0})) {
    expect_near(force, {points[index(node)][2] / c * M / (4 * c), 0.0, 0.0}, 1e-14);
  }
  for (const auto& [node, force, curve] : consistent_loads(points, {{0, 1, 2, 3}}, {}, {M, 0.0, 0.0})) {
    const auto& X = points[index(node)];
    // By symmetry (0, -z, y) s; 4 corners at distance c sqrt(2): M = 8 c^2 s.
    const double s = M / (8 * c * c);
    expect_near(force, {0.0, -s * X[2], s * X[1]}, 1e-14);
  }
}

/// Sum and moment of the nodal loads are exact on warped faces too, and about any point.
TEST(FaceLoad, sum_and_moment_are_exact_on_warped_faces) {
  RandomGeometry random(41);
  Mesh mesh = box({1.0, 2.0, 3.0}, {2, 3, 4});
  for (auto& X : mesh.points) {
    for (double& x : X) x += random.uniform(-0.1, 0.1);
  }
  const auto faces = faces_within(boundary_faces(mesh.cells),
                                  nodes_where(mesh.points, [](const Vector& X) { return X[2] > 2.6; }));
  ASSERT_EQ(faces.size(), 6U);
  const Vector F{0.3, -0.7, 0.2}, M{-0.4, 0.6, 0.9};
  const auto pulled = consistent_loads(mesh.points, faces, F, {});
  expect_near(sum_of(pulled), F, 1e-15);
  const auto turned = consistent_loads(mesh.points, faces, {}, M);
  expect_near(sum_of(turned), {}, 1e-14);
  expect_near(moment_of(turned, mesh.points, {}), M, 1e-13);
  expect_near(moment_of(turned, mesh.points, {5.0, -3.0, 1.0}), M, 1e-13);
  // The sum acts at the centroid: it has no moment about the point that a force alone does not turn.
  const auto both = consistent_loads(mesh.points, faces, F, M);
  const Vector alone = moment_of(pulled, mesh.points, {});
  expect_near(moment_of(both, mesh.points, {}), {alone[0] + M[0], alone[1] + M[1], alone[2] + M[2]}, 1e-13);
}

TEST(FaceLoad, only_boundary_faces_with_all_nodes_in_the_set_are_loaded) {
  const Mesh mesh = box({1.0, 1.0, 1.0}, {3, 3, 3});
  const auto all = nodes_where(mesh.points, [](const Vector&) { return true; });
  EXPECT_EQ(faces_within(boundary_faces(mesh.cells), all).size(),
            6U * 9);  // inner faces too have all their nodes in the set
  const auto strip = nodes_where(mesh.points, [](const Vector& X) { return X[2] == 1.0 && X[0] < 0.4; });
  EXPECT_EQ(faces_within(boundary_faces(mesh.cells), strip).size(), 3U);
  const auto edge = nodes_where(mesh.points, [](const Vector& X) { return X[2] == 1.0 && X[0] == 0.0; });
  EXPECT_TRUE(faces_within(boundary_faces(mesh.cells), edge).empty());
}

/// A bar on three planes of symmetry, pulled along z by a force on its end.
CaseOnMesh pulled_bar_case(const AnyLaw& law, double force) {
  Case description = plain_case(law);
  Mesh mesh = box({0.1, 0.2, 0.4}, {2, 2, 4});
  NodeSets sets{{"end", nodes_where(mesh.points, [](const Vector& X) { return X[2] == 0.4; })}};
  for (std::size_t i = 0; i < 3; ++i) {
    const std::string name = std::string("plane ") + "xyz"[i];
    sets[name] = nodes_where(mesh.points, [i](const Vector& X) { return X[i] == 0.0; });
    ImposedDisplacement held{name, {}, {}};
    held.components[i] = true;
    description.displacements.push_back(held);
  }
  description.forces.of<DeadForce>() = {{"end", {0.0, 0.0, force}, {}}};
  return {description, mesh, sets};
}

Scene pulled_bar(const AnyLaw& law, double force) {
  return make_scene(pulled_bar_case(law, force));
}

class LoadTest : public PairTest {};

INSTANTIATE_TEST_SUITE_P(, LoadTest, each_of_pairs(PairsOf<PathIndependentMethods>{}), pair_label);

/// A bar under a dead load on its end stretches uniformly; its first Piola-Kirchhoff stress along z is the
/// load over the undeformed area, all other stresses vanish. Tested at small strain, and at a stress of a
/// third of Young's modulus. A residual of 1e-8 leaves stresses of that fraction of the largest.
TEST_P(LoadTest, bar_under_end_load_has_uniaxial_stress) {
  const AnyLaw law = this->law();
  if (leaves_hourglass_modes(choice())) return;  // displacements in such modes depend on the path
  if (has_fibres(law)) return;                   // in other directions they shear the bar
  for (const double stress : {1e-6, bearable_load(law) / 3.0}) {
    const double force = stress * young_modulus_of(law) * 0.1 * 0.2;
    const Scene scene = pulled_bar(law, force);
    Observer silent;
    const Relaxation answer = relax(Model(scene, choice()), silent);
    ASSERT_TRUE(answer.converged);
    const Vector& u = answer.u.back();
    const Tensor<double> H{{u[0] / 0.1, 0, 0, 0, u[1] / 0.2, 0, 0, 0, u[2] / 0.4}};
    const Tensor<double> P = exact_stress(method.is_linear, law, H);
    EXPECT_NEAR(P(2, 2) * 0.1 * 0.2 / force, 1.0, 1e-6);
    EXPECT_NEAR(P(0, 0) * 0.1 * 0.2 / force, 0.0, 1e-6);
    EXPECT_NEAR(P(1, 1) * 0.1 * 0.2 / force, 0.0, 1e-6);
    for (std::size_t n = 0; n < answer.u.size(); ++n) {
      const Vector exact = linear(H, scene.mesh.points[n]);
      expect_near(answer.u[n], exact, 1e-6 * std::abs(u[2]));
    }
  }
}

/// With loads but no internal forces yet, a body is out of balance by all of its loads: the residual is one,
/// at any factor of the loads.
TEST(Residual, is_relative_to_the_loads) {
  const Scene scene = pulled_bar(sample_law<NeoHookean>(0.3), 2.0);
  const Model model(scene, {"tl-perturbation"});
  Body<double> body(model, *std::get<std::unique_ptr<InternalForce<double>>>(model.internal_force()));
  for (const double factor : {0.01, 1.0}) {
    body.impose(factor);
    body.evaluate_forces();
    EXPECT_NEAR(body.residual(), 1.0, 1e-14) << factor;
  }
}

/// In the linear range the work of the loads is half of load times displacement, and all of it is stored.
TEST_P(LoadTest, work_is_stored_in_the_small) {
  const AnyLaw law = this->law();
  const double force = 1e-7 * young_modulus_of(law) * 0.1 * 0.2;
  const Scene scene = pulled_bar(law, force);
  Recorder recorder;
  const Relaxation answer = relax(Model(scene, choice()), recorder);
  double path = 0.0;
  for (const auto& load : dead_loads(scene.forces)) path += load.force[2] * answer.u[index(load.node)][2];
  EXPECT_NEAR(recorder.rows.back().external_work / (0.5 * path), 1.0, 1e-12);
  // At a force of 1e-7 E energy is off by about half of that; the residual adds 1e-8.
  EXPECT_NEAR(total_energy(recorder.rows.back()) / (0.5 * path), 1.0, 1e-6);
}

/// The work of the loads is the body's energy, kinetic + strain + hourglass, to second order.
TEST_P(LoadTest, work_of_loads_balances_energies_of_a_motion) {
  if (method.is_condensed) return;  // takes no steps
  const AnyLaw law = this->law();
  const auto imbalance = [&](double fraction) {
    Scene scene = pulled_bar(law, 0.1 * young_modulus_of(law) * 0.1 * 0.2);
    scene.settings.quasi_static = false;
    const Model probe(scene, choice());
    DynamicsSettings& settings = scene.settings.dynamics;
    settings.time_step = fraction * stable_step(probe, NodalField(scene.mesh.points.size())).step;
    settings.duration = 0.3;
    settings.ramp_time = 0.2;
    settings.check_interval = 1;
    Recorder recorder;
    integrate(Model(scene, choice()), recorder);
    return energy_imbalance(recorder.rows);
  };
  // (omega dt)^2 is .01 to .1; second-order terms partly cancel, so the ratio may be below 4.
  const double coarse = imbalance(0.4), fine = imbalance(0.2);
  EXPECT_LT(coarse, 4e-3);
  EXPECT_LT(fine, 1e-3);
  EXPECT_GT(coarse / fine, 1.9);
}

/// A free body under a force that follows the loading curve has the momentum F T / 2 at the end of the ramp,
/// since the curve's mean is 1/2. Its first and third derivatives are equal at both ends, so the sum over n
/// equal steps has an error of n^-6 (Euler and Maclaurin), here 1e-9. Wrong times or factors exceed that.
TEST(Load, force_gives_a_free_body_its_momentum) {
  Case description = plain_case(sample_law<NeoHookean>(0.3));
  description.quasi_static = false;
  description.dynamics.duration = 0.2;
  description.dynamics.time_step = 0.2 / 32;
  const Mesh mesh = box({0.1, 0.1, 0.1}, {2, 2, 2});
  const NodeSets sets{{"top", nodes_where(mesh.points, [](const Vector& X) { return X[2] == 0.1; })}};
  const Vector F{0.2, -0.1, 0.4};
  description.forces.of<DeadForce>() = {{"top", F, {}}};
  const Scene scene = make_scene(description, mesh, sets);
  const Model model(scene, {"tl-full", {}});
  Observer silent;
  const Motion motion = integrate(model, silent);
  Vector momentum{};
  for (std::size_t n = 0; n < motion.v.size(); ++n) {
    for (std::size_t i = 0; i < 3; ++i) momentum[i] += model.masses()[n] * motion.v[n][i];
  }
  for (std::size_t i = 0; i < 3; ++i) EXPECT_NEAR(momentum[i] / (0.5 * 0.2 * F[i]), 1.0, 1e-9);
}

/// Loads on held nodes go directly into the reactions, which balance all loads; nothing moves.
TEST(Load, reactions_carry_all_loads) {
  Case description = plain_case(sample_law<NeoHookean>(0.3));
  const Mesh mesh = box({0.1, 0.1, 0.2}, {2, 2, 2});
  const NodeSets sets{{"foot", nodes_where(mesh.points, [](const Vector& X) { return X[2] == 0.0; })},
                      {"head", nodes_where(mesh.points, [](const Vector& X) { return X[2] == 0.2; })}};
  description.displacements = {{"foot", {}}};
  description.forces.of<DeadForce>() = {{"foot", {0.0, 3.0, 0.0}, {}}, {"head", {0.0, 0.01, 0.02}, {}}};
  const Scene scene = make_scene(description, mesh, sets);
  expect_near(sum_of(dead_loads(scene.forces)), {0.0, 3.01, 0.02}, 1e-15);
  const Model model(scene, {"tl-perturbation", {}});
  Observer silent;
  const Relaxation answer = relax(model, silent);
  ASSERT_TRUE(answer.converged);
  const auto& elements = *std::get<std::unique_ptr<InternalForce<double>>>(model.internal_force());
  Body<double> body(model, elements);
  body.state() = state_at(elements, answer.u);
  body.impose(1.0);
  body.evaluate_forces();
  Vector sum{};
  for (std::size_t k = 0; k < scene.constraints.size(); ++k) {
    sum[index(scene.constraints[k].component)] += body.reactions()[k];
  }
  expect_near(sum, {0.0, -3.01, -0.02}, 3e-8);  // the residual, 1e-8 of loads and reactions
}

/// Forces on sets that share faces add up, to a few roundings.
TEST(Load, forces_on_one_node_add_up) {
  const auto pulled = [](const std::vector<DeadForce>& forces) {
    CaseOnMesh problem = pulled_bar_case(sample_law<NeoHookean>(0.3), 0.0);
    problem.description.forces.of<DeadForce>() = forces;
    return dead_loads(make_scene(problem).forces);
  };
  const auto both = pulled({{"end", {0.1, 0.0, 0.4}, {}}, {"end", {0.2, -0.3, 0.0}, {0.0, 0.05, 0.0}}});
  const auto once = pulled({{"end", {0.3, -0.3, 0.4}, {0.0, 0.05, 0.0}}});
  ASSERT_EQ(both.size(), once.size());
  for (std::size_t k = 0; k < both.size(); ++k) {
    EXPECT_EQ(both[k].node, once[k].node);
    expect_near(both[k].force, once[k].force, 1e-15);
  }
}

/// Relative errors are in units of the largest imposed displacement; if there are only forces, of the
/// reference's largest displacement.
TEST(Load, unit_of_errors_without_imposed_displacement_is_the_references_own) {
  CaseOnMesh problem = pulled_bar_case(sample_law<NeoHookean>(0.3), 1.0);
  const Scene scene = make_scene(problem);
  const NodalField reference{{0, 0, 0}, {0.3, 0.0, -0.4}, {0.1, 0.1, 0.1}};
  EXPECT_EQ(largest_imposed(scene), 0.0);
  EXPECT_EQ(displacement_unit(scene, reference), 0.5);
  problem.description.displacements.push_back({"end", {0.0, 0.0, 0.02}, {false, false, true}});
  EXPECT_EQ(displacement_unit(make_scene(problem), reference), 0.02);
}

/// Scaling a scene equals scaling every table of its case: displacements, angles, forces with and without
/// curves, and velocities, to a few roundings.
TEST(Scaled, is_the_case_with_more_in_every_table) {
  constexpr double factor = 1.5;
  const auto loaded = [](double by) {
    CaseOnMesh problem = pulled_bar_case(sample_law<NeoHookean>(0.3), 0.4 * by);
    Case& description = problem.description;
    problem.sets["foot"] = nodes_where(problem.mesh.points, [](const Vector& X) { return X[2] == 0.0; });
    problem.sets["middle"] = nodes_where(problem.mesh.points, [](const Vector& X) { return X[2] == 0.2; });
    description.displacements = {{"foot", {0.01 * by, 0.0, 0.0}}};
    description.rotations = {{"middle", {0.0, 0.0, 1.0}, 0.3 * by, {}, {0.0, 0.0, 0.02 * by}}};
    description.quasi_static = false;
    description.velocities = {{.value = {0.1 * by, 0.0, 0.0}, .spin = {0.0, 0.2 * by, 0.0}}};
    auto& forces = description.forces.of<DeadForce>();
    forces.push_back({"end", {0.1 * by, 0.0, 0.0}, {}});
    forces.back().curve = {.times = {0.0, 1.0}, .factors = {0.2, 0.8}};
    description.forces.of<Gravity>() = {{{0.0, 9.81 * by, 0.0}, {.formula = Formula("sin(t)")}}};
    return make_scene(problem);
  };
  const Scene scene = scaled(loaded(1.0), factor), expected = loaded(factor);
  ASSERT_EQ(scene.constraints.size(), expected.constraints.size());
  for (std::size_t k = 0; k < scene.constraints.size(); ++k) {
    EXPECT_NEAR(final_value(scene, scene.constraints[k]), final_value(expected, expected.constraints[k]),
                1e-16);
  }
  EXPECT_NEAR(largest_imposed(scene), largest_imposed(expected), 1e-16);
  EXPECT_LT(largest_distance(scene.initial_velocities, expected.initial_velocities), 1e-15);
  const auto loads = dead_loads(scene.forces), more = dead_loads(expected.forces);
  ASSERT_EQ(loads.size(), more.size());
  ASSERT_EQ(scene.curves.size(), 3U);
  for (std::size_t k = 0; k < loads.size(); ++k) {
    for (const double time : {0.25, 0.5, 2.0}) {
      const double by = scene.curves[loads[k].curve].at(time, 0.5),
                   at = expected.curves[more[k].curve].at(time, 0.5);
      for (std::size_t i = 0; i < 3; ++i) EXPECT_NEAR(by * loads[k].force[i], at * more[k].force[i], 1e-15);
    }
  }
  for (std::size_t c = 0; c < scene.curves.size(); ++c)
    EXPECT_NEAR(scene.curves[c].largest(2.0), factor * expected.curves[c].largest(2.0), 1e-15);
  EXPECT_EQ(scene.case_hash, "");
}

/// A force on nodes needs no face, and three nodes carry a third each; as the edge of a face, they would
/// carry a quarter, a half and a quarter.
TEST(Load, force_on_nodes_is_shared_equally) {
  Case description = plain_case(sample_law<NeoHookean>(0.3));
  const Mesh mesh = box({0.1, 0.1, 0.1}, {2, 2, 2});
  const NodeSets sets{
      {"edge", nodes_where(mesh.points, [](const Vector& X) { return X[2] == 0.1 && X[0] == 0.0; })}};
  description.forces.of<DeadForce>() = {
      {.set = "edge", .total = {0.3, 0.0, -0.6}, .on = DeadForce::Carrier::nodes}};
  const auto loads = dead_loads(make_scene(description, mesh, sets).forces);
  ASSERT_EQ(loads.size(), 3U);
  for (std::size_t k = 0; k < 3; ++k) {
    EXPECT_EQ(loads[k].node, sets.at("edge")[k]);
    expect_near(loads[k].force, {0.1, 0.0, -0.2}, 1e-16);
  }
}

TEST(Load, set_without_faces_is_refused) {
  Case description = plain_case(sample_law<NeoHookean>(0.3));
  const Mesh mesh = box({0.1, 0.1, 0.1}, {2, 2, 2});
  description.forces.of<DeadForce>() = {{"edge", {1.0, 0.0, 0.0}, {}}};
  const NodeSets sets{
      {"edge", nodes_where(mesh.points, [](const Vector& X) { return X[2] == 0.1 && X[0] == 0.0; })}};
  const std::string text = input_error([&] { make_scene(description, mesh, sets); });
  EXPECT_TRUE(
      contains(text, "made-in-a-test.toml: force.set = 'edge' has no boundary face among its 3 nodes"));
  description.forces.of<DeadForce>() = {{"egde", {1.0, 0.0, 0.0}, {}}};
  EXPECT_TRUE(contains(input_error([&] { make_scene(description, mesh, sets); }), "did you mean 'edge'?"));
}

}  // namespace
}  // namespace sandglass::verification::load_test
