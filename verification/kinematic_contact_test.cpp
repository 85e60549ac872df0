/// Rigid obstacles by the kinematic method: no node is inside, and nodes that slide or rest lose no energy.

#include <gtest/gtest.h>

#include "io/case_file.hpp"
#include "solve/central_difference.hpp"
#include "solve/leapfrog.hpp"
#include "support/momentum.hpp"
#include "support/obstacles.hpp"
#include "support/random_hexahedra.hpp"
#include "support/temporary_folder.hpp"

namespace sandglass::verification::kinematic_contact_test {
namespace {

/// With the kinematic method no node is inside, nothing is held back, and the bar on the wall is stopped as
/// by the penalty; nodes that hit it lose the share of the kinetic energy that is in them, an
/// eightieth.
TEST(KinematicContact, stops_a_bar_as_derived) {
  const double L = 0.2, a = 0.02, E = 2e11, rho = 8000.0, v = 100.0, c = std::sqrt(E / rho),
               lasts = 2.0 * L / c;
  Column bar({a, a, L}, {2, 2, 40}, NeoHookean{.young_modulus = E, .poisson_ratio = 0.0});
  bar.description.materials.front().density = rho;
  bar.description.quasi_static = false;
  bar.description.velocities = {{.set = "", .value = {0.0, 0.0, -v}}};
  Obstacle wall = ground();
  wall.method = Obstacle::Method::kinematic;
  bar.description.forces.of<Obstacle>() = {wall};
  bar.description.dynamics.duration = 1.5 * lasts;
  bar.description.dynamics.check_interval = 1;
  const Scene scene = bar.scene();
  const Model model(scene, {"linear"});
  Recorder recorder;
  const Motion motion = integrate(model, recorder);
  const double start = total_energy(recorder.rows.front()), mass = rho * L * a * a;
  double impulse = 0.0;
  for (std::size_t n = 1; n < recorder.rows.size(); ++n) {
    const HistoryRow& row = recorder.rows[n];
    EXPECT_NEAR(total_energy(row), start, 0.01 * start);
    EXPECT_LT(row.friction, 1.1 * start / 80.0);
    EXPECT_GE(row.reactions.at("ground")[2], 0.0);
    EXPECT_EQ(row.depth, 0.0);
    impulse += row.reactions.at("ground")[2] * (row.time - recorder.rows[n - 1].time);
  }
  EXPECT_NEAR(impulse, 2.0 * mass * v, 0.01 * 2.0 * mass * v);
  EXPECT_NEAR(centre_of(motion.v, model.masses())[2], v, 0.03 * v);
  for (const Vector& u : motion.u) EXPECT_GT(u[2], 0.0);
}

/// A smooth rod that presses a damped body: the nodes that slide along its curve come to rest, and the
/// obstacle does as much work as the body stores and damps. Pushed along the normals at the ends of steps,
/// they gained forty times that work and never came to rest.
TEST(KinematicContact, does_no_work_on_nodes_that_slide) {
  const TemporaryFolder folder;
  const Scene scene = read_scene(folder.write("rod.toml", R"(
[case]
name = "rod"
requirement = "rest"
answer = "dynamic"
[mesh]
generator = "box"
size = [0.06, 0.06, 0.05]
elements = [8, 8, 7]
[material]
law = "neo-hookean"
young_modulus = 5000.0
poisson_ratio = 0.45
density = 1000.0
[sets]
base = { z = [0, 0] }
side = { x = [0, 0] }
[[displacement]]
set = "base"
value = [0, 0, 0]
[[obstacle]]
name = "rod"
set = "side"
shape = "capsule"
point = [-0.01, 0, 0.03]
end = [-0.01, 0.06, 0.03]
radius = 0.01
displacement = [0.008, 0, 0]
[dynamics]
duration = 2.0
ramp_time = 0.5
damping = 15.0
)"));
  Recorder recorder;
  integrate(Model(scene, {"tl-perturbation"}), recorder);
  const HistoryRow& last = recorder.rows.back();
  EXPECT_LT(last.kinetic, 1e-4 * last.external_work);
  EXPECT_NEAR(last.friction, 0.0, 1e-3 * last.external_work);
  EXPECT_NEAR(last.reactions.at("rod")[0], -last.reactions.at("base")[0], 1e-3);
}

/// A cube slides into a groove of two planes, with friction. Both push the nodes of its lowest edge in the
/// same step: what one takes, the other may give back, so that only their sum is lost. At rest nothing is
/// lost, the velocities of frames are zero, and forces carry the weight. Counted one by one, they lost twice
/// the largest energy while nothing moved.
TEST(KinematicContact, rests_in_a_groove) {
  const double a = 0.1, half = std::sqrt(0.5);
  Column cube({a, a, a}, {4, 4, 4}, NeoHookean{.young_modulus = 2e4, .poisson_ratio = 0.3});
  for (Vector& X : cube.mesh.points) X = {half * (X[0] - X[2]), X[1], half * (X[0] + X[2])};
  cube.description.quasi_static = false;
  cube.description.forces.of<Gravity>() = {{{0.0, 0.0, -9.81}, {{0.0, 0.5}, {0.0, 1.0}}}};
  for (const double side : {-1.0, 1.0}) {
    Obstacle plane = ground();
    plane.label = side < 0.0 ? "right" : "left";
    plane.set = side < 0.0 ? "side" : "foot";
    plane.normal = {side, 0.0, 1.0};
    plane.friction = 0.3;
    plane.method = Obstacle::Method::kinematic;
    cube.description.forces.of<Obstacle>().push_back(plane);
  }
  cube.description.dynamics.duration = 2.0;
  for (const double damping : {0.0, 30.0}) {
    cube.description.dynamics.damping = damping;
    const Scene scene = cube.scene();
    Recorder recorder;
    const Motion motion = integrate(Model(scene, {"tl-perturbation"}), recorder);
    EXPECT_EQ(motion.repeated, 0);
    double largest = 0.0;
    for (const HistoryRow& row : recorder.rows) largest = std::max(largest, row.external_work);
    for (const HistoryRow& row : recorder.rows)  // damping is integrated from row to row
      EXPECT_NEAR(total_energy(row), row.external_work, (damping > 0.0 ? 0.01 : 1e-5) * largest) << row.time;
    if (damping == 0.0) continue;
    const HistoryRow& last = recorder.rows.back();
    const double weight = 9.81 * 1000.0 * a * a * a;
    EXPECT_NEAR(last.reactions.at("left")[2] + last.reactions.at("right")[2], weight, 1e-3 * weight);
    for (const Vector& v : motion.v) EXPECT_LT(length(v), 1e-6);
  }
}

/// A block comes to rest in the corner of a box, and on a table whose edge is nearer to its nodes than a step
/// without contact would carry them: they stop at the side through which they came, and then at what else
/// they are beyond. At the nearest side alone, the block was pushed off the table, and never came to rest in
/// the box.
TEST(KinematicContact, stops_nodes_beside_edges) {
  const auto rest = [](Column& block, const Vector& g, const Obstacle& obstacle) {
    block.description.quasi_static = false;
    block.description.forces.of<Gravity>() = {{g, {{0.0, 0.2}, {0.0, 1.0}}}};
    block.description.forces.of<Obstacle>() = {obstacle};
    block.description.dynamics.duration = 3.0;
    block.description.dynamics.damping = 20.0;
    Recorder recorder;
    const Scene scene = block.scene();
    const Motion motion = integrate(Model(scene, {"tl-perturbation"}), recorder);
    for (const Vector& v : motion.v) EXPECT_LT(length(v), 1e-5);
    EXPECT_GE(recorder.rows.back().friction, -1e-12);
    return std::pair(motion.u, recorder.rows.back().reactions.at(obstacle.label));
  };
  const double a = 0.1, weight = 1000.0 * a * a * a;
  Obstacle box{.label = "box", .shape = Obstacle::Shape::box};
  for (const int n : {1, 2, 3}) {
    Column block({a, a, a}, {n, n, n}, NeoHookean{.young_modulus = 2e4, .poisson_ratio = 0.3});
    block.sets["all"] = nodes_where(block.mesh.points, [](const Vector&) { return true; });
    box.set = "all";
    box.point = {0.05, 0.05, 0.05};
    box.half_sizes = {0.051, 0.051, 0.051};
    box.inside = true;
    const auto in_box = rest(block, {3.0, 2.0, -9.0}, box).second;
    EXPECT_LT(distance(in_box, {-3.0 * weight, -2.0 * weight, 9.0 * weight}), 1e-3 * weight) << n;
    for (const double margin : {0.0005, 0.002, 0.004}) {
      box.set = "foot";
      box.inside = false;
      box.point = {0.05, 0.05, -0.1};
      box.half_sizes = {0.05 + margin, 0.05 + margin, 0.1};
      box.friction = 0.5;
      const auto [u, on_table] = rest(block, {0.0, 0.0, -9.0}, box);
      EXPECT_LT(distance(on_table, {0.0, 0.0, 9.0 * weight}), 1e-3 * weight) << n << ", " << margin;
      for (const int node : block.sets.at("foot")) {
        EXPECT_NEAR(u[at(node)][2], 0.0, 1e-9) << n << ", " << margin;
        EXPECT_LT(std::abs(u[at(node)][0]), 0.1 * a) << n << ", " << margin;
      }
      box.friction = 0.0;
    }
  }
}

/// A plane jumps between afar and within the body in single steps: no node stays inside, however far from it
/// the last distance was computed. The body is freed and vibrates in between.
TEST(KinematicContact, finds_nodes_from_wherever_it_comes) {
  Column block({1.0, 1.0, 0.5}, {4, 4, 2}, NeoHookean{.young_modulus = 1e4, .poisson_ratio = 0.4});
  block.description.quasi_static = false;
  block.description.displacements = {{"foot", {}}};
  Obstacle plate = ceiling(0.5, 0.0);
  plate.method = Obstacle::Method::kinematic;
  block.description.forces.of<Obstacle>() = {plate};
  const Scene scene = block.scene();
  const Model model(scene, {"tl-perturbation"});
  Leapfrog<double> leapfrog(model, double_elements(model), 20.0);
  const double step = 0.5 * leapfrog.stable_step(model).step;
  std::vector<double> targets(scene.constraints.size() + 3, 0.0);  // the last is the height of the plate
  double& height = targets.back();
  const auto highest = [&] {
    const NodalField u = leapfrog.body().field(leapfrog.body().state().u);
    double z = -INFINITY;
    for (const int node : block.sets.at("top")) z = std::max(z, u[at(node)][2]);
    return z;
  };
  RandomGeometry random(47);
  int touched = 0, apart = 0;
  for (int n = 0; n < 2000; ++n) {
    constexpr double deepest = 2e-3;
    const double choice = random.uniform(0.0, 1.0), top = highest();
    if (choice > 0.8) height = top + random.uniform(0.0, 0.5);
    if (choice < 0.2) height = top - random.uniform(0.0, deepest);
    leapfrog.advance(step, [&](Body<double>& body) { body.impose(targets, 1.0, n * step); });
    ASSERT_LE(highest(), height + 1e-14);
    ++(leapfrog.body().touch("plate")->force[2] < 0.0 ? touched : apart);
  }
  EXPECT_GT(touched, 400);
  EXPECT_GT(apart, 400);
}

}  // namespace
}  // namespace sandglass::verification::kinematic_contact_test
