/// Bodies that hit rigid obstacles, rest on them and rub: closed forms, energies, the same bits after a
/// checkpoint and for any number of threads.

#include <gtest/gtest.h>

#include "solve/central_difference.hpp"
#include "solve/leapfrog.hpp"
#include "solve/relaxation.hpp"
#include "support/allocations.hpp"
#include "support/kept_run.hpp"
#include "support/momentum.hpp"
#include "support/obstacles.hpp"
#include "support/random_hexahedra.hpp"
#include "support/random_scene.hpp"

namespace sandglass::verification::contact_motion_test {
namespace {

constexpr std::array both_methods{Obstacle::Method::penalty, Obstacle::Method::kinematic};

/// A bar flies onto a wall (SDNV100 of Code_Aster): it is stopped by a wave of the stress rho c v, and leaves
/// after 2 L / c with its velocity reversed. The scheme rings, so that means count.
TEST(Contact, stops_a_bar_as_derived) {
  const double L = 0.2, a = 0.02, E = 2e11, rho = 8000.0, v = 100.0, gap = 0.002;
  const double c = std::sqrt(E / rho), touch = gap / v, lasts = 2.0 * L / c, force = rho * c * v * a * a;
  Column bar({a, a, L}, {2, 2, 40}, NeoHookean{.young_modulus = E, .poisson_ratio = 0.0});
  bar.description.materials.front().density = rho;
  bar.description.quasi_static = false;
  bar.description.velocities = {{.set = "", .value = {0.0, 0.0, -v}}};
  Obstacle wall = ground();
  wall.point = {0.0, 0.0, -gap};
  bar.description.forces.of<Obstacle>() = {wall};
  bar.description.dynamics.duration = touch + 1.5 * lasts;
  bar.description.dynamics.check_interval = 1;
  Recorder recorder;
  const Scene scene = bar.scene();
  const Model model(scene, {"linear"});
  const Motion motion = integrate(model, recorder);
  double impulse = 0.0, plateau = 0.0, time = 0.0;
  const double start = total_energy(recorder.rows.front());
  for (std::size_t n = 1; n < recorder.rows.size(); ++n) {
    const HistoryRow &row = recorder.rows[n], &before = recorder.rows[n - 1];
    const double f = row.reactions.at("ground")[2], step = row.time - before.time;
    // The bar stands in the first quadrant beside the point of the ground: its middle is the arm.
    EXPECT_NEAR(row.moments.at("ground")[1], -0.5 * a * f, 1e-9 * force);
    EXPECT_LE(total_energy(row), 1.002 * start);
    impulse += 0.5 * step * (f + before.reactions.at("ground")[2]);
    if (row.time > touch + 0.2 * lasts && row.time < touch + 0.8 * lasts) {
      plateau += step * f;
      time += step;
    }
  }
  const double mass = rho * L * a * a;
  EXPECT_NEAR(plateau / time, force, 0.01 * force);
  EXPECT_NEAR(impulse, 2.0 * mass * v, 0.01 * 2.0 * mass * v);
  double momentum = 0.0;
  for (std::size_t n = 0; n < motion.v.size(); ++n) momentum += model.masses()[n] * motion.v[n][2];
  EXPECT_NEAR(momentum, mass * v, 0.01 * mass * v);
}

/// A block rests under gravity: energy is neither gained nor lost in 1e5 steps, and nothing drifts sideways.
TEST(Contact, lets_a_block_rest) {
  Column block({1.0, 1.0, 1.0}, {2, 2, 2}, NeoHookean{.young_modulus = 1e5, .poisson_ratio = 0.3});
  block.description.quasi_static = false;
  block.description.forces.of<Gravity>() = {{{0.0, 0.0, -10.0}, {{0.0, 1.0}, {1.0, 1.0}}}};
  block.description.forces.of<Obstacle>() = {ground()};
  block.description.dynamics.check_interval = 100;
  const Scene at_rest = block.scene();
  block.description.dynamics.time_step = 0.005;
  block.description.dynamics.duration = 500.0;
  const Scene scene = block.scene();
  Recorder recorder;
  const Model model(scene, {"tl-perturbation"});
  const Motion motion = integrate(model, recorder);
  EXPECT_EQ(motion.steps, 100000);
  EXPECT_EQ(motion.repeated, 0);
  double largest = 0.0;
  for (const HistoryRow& row : recorder.rows) largest = std::max(largest, row.strain + row.contact);
  EXPECT_GT(largest, 1.0);
  for (const HistoryRow& row : recorder.rows)
    EXPECT_NEAR(total_energy(row), row.external_work, 0.02 * largest) << row.time;
  double sideways = 0.0;  // of the centre of mass
  for (std::size_t n = 0; n < motion.u.size(); ++n) sideways += model.masses()[n] * motion.u[n][0] / 1000.0;
  EXPECT_NEAR(sideways, 0.0, 1e-10);
}

/// A plate that moves into a block works on it, and what it works is there; taken back, it leaves the block
/// without a force.
TEST(Contact, works_as_it_moves) {
  Column block({1.0, 1.0, 1.0}, {3, 3, 3}, NeoHookean{.young_modulus = 1e5, .poisson_ratio = 0.45});
  block.description.quasi_static = false;
  block.description.displacements = {{"foot", {}}};
  Obstacle plate = ceiling(1.02, 0.2);
  plate.curve = {{0.0, 0.3, 0.6}, {0.0, 1.0, 0.0}};
  block.description.forces.of<Obstacle>() = {plate};
  block.description.dynamics.duration = 0.3;
  block.description.dynamics.check_interval = 5;
  Recorder pressed;
  const Scene scene = block.scene();
  integrate(Model(scene, {"tl-perturbation"}), pressed);
  EXPECT_LT(energy_imbalance(pressed.rows), 0.01);
  EXPECT_GT(pressed.rows.back().contact, 0.0);
  block.description.dynamics.duration = 0.6;
  Recorder released;
  const Scene longer = block.scene();
  integrate(Model(longer, {"tl-perturbation"}), released);
  EXPECT_EQ(released.rows.back().reactions.at("plate"), Vector{});
  EXPECT_EQ(released.rows.back().contact, 0.0);
}

/// Steps allocate nothing, and have the same bits for any number of threads: of both methods.
TEST(Contact, takes_steps_like_any_force) {
  for (const auto method : both_methods) {
    Column block({1.0, 1.0, 1.0}, {4, 4, 4}, NeoHookean{.young_modulus = 1e5, .poisson_ratio = 0.3});
    block.description.quasi_static = false;
    block.description.dynamics.duration = 0.1;
    Obstacle wall = ground();
    wall.friction = 0.3;
    wall.method = method;
    block.description.velocities = {{.set = "", .value = {0.5, 0.0, -1.0}}};
    block.description.forces.of<Obstacle>() = {wall};
    const Scene scene = block.scene();
    const Model model(scene, {"tl-perturbation"});
    const auto& elements = *std::get<std::unique_ptr<InternalForce<double>>>(model.internal_force());
    Leapfrog<double> leapfrog(model, elements, 0.0);
    leapfrog.set_initial_velocities(scene.initial_velocities);
    const auto step = [&] { leapfrog.advance(1e-3, [](Body<double>& body) { body.impose(1.0, 0.0); }); };
    step();
    const long before = allocations();
    for (int k = 0; k < 20; ++k) step();
    EXPECT_EQ(allocations(), before);
    EXPECT_GT(leapfrog.body().touch("ground")->force[2], 0.0);
    const auto moved = [&](int threads) {
      Recorder silent;
      return integrate(Model(scene, {"tl-perturbation", {}, Precision::double_precision, threads}), silent).u;
    };
    EXPECT_EQ(moved(1), moved(2));
  }
}

constexpr double coefficient = 0.3, gravity = 10.0;

/// A flat block on rough ground, under a weight that pulls it sideways by a share of itself.
struct Slab {
  Column column{{1.0, 1.0, 0.2}, {4, 4, 2}, NeoHookean{.young_modulus = 1e6, .poisson_ratio = 0.3}};

  Slab(Obstacle::Method method, double share, double speed, double duration) {
    Case& d = column.description;
    d.quasi_static = false;
    d.forces.of<Gravity>() = {{{share * gravity, 0.0, -gravity}, {{0.0, 1.0}, {1.0, 1.0}}}};
    Obstacle rough = ground();
    rough.friction = coefficient;
    rough.method = method;
    d.forces.of<Obstacle>() = {rough};
    if (speed > 0.0) d.velocities = {{.set = "", .value = {speed, 0.0, 0.0}}};
    d.dynamics.duration = duration;
    d.dynamics.check_interval = 1;
  }
};

/// Friction stops a block after the time v / (mu g), on the way v^2 / (2 mu g), and takes its energy. It
/// bounces on its own elasticity, which a few percent allow for.
TEST(Friction, stops_a_block_as_derived) {
  for (const auto method : both_methods) {
    const double speed = 2.0, time = speed / (coefficient * gravity), way = 0.5 * speed * time;
    const Slab slab(method, 0.0, speed, 1.5 * time);
    const Scene scene = slab.column.scene();
    const Model model(scene, {"tl-perturbation"});
    Recorder recorder;
    const Motion motion = integrate(model, recorder);
    const double mass = 200.0, energy = 0.5 * mass * speed * speed;
    EXPECT_NEAR(centre_of(motion.u, model.masses())[0], way, 0.03 * way);
    EXPECT_NEAR(recorder.rows.back().friction, energy, 0.05 * energy);
    double impulse = 0.0, before = 0.0;
    for (std::size_t n = 1; n < recorder.rows.size(); ++n) {
      const HistoryRow& row = recorder.rows[n];
      const Vector& force = row.reactions.at("ground");
      EXPECT_LE(std::hypot(force[0], force[1]), coefficient * force[2] * (1.0 + 1e-9) + 1e-9);
      EXPECT_LE(total_energy(row) - row.external_work, 1.01 * total_energy(recorder.rows.front()));
      EXPECT_GE(row.friction, before - 1e-3 * energy);
      before = row.friction;
      impulse += force[0] * (row.time - recorder.rows[n - 1].time);
    }
    EXPECT_NEAR(impulse, -mass * speed, 0.03 * mass * speed);
  }
}

/// Below the coefficient of friction a block sticks: once its vibrations are damped it does not creep at all.
/// Above, it slides with the difference.
TEST(Friction, holds_a_block_below_its_coefficient) {
  for (const auto method : both_methods) {
    Slab slab(method, 0.8 * coefficient, 0.0, 4.0);
    slab.column.description.dynamics.damping = 40.0;
    slab.column.description.dynamics.frames = 4;
    const Scene scene = slab.column.scene();
    const Model model(scene, {"tl-perturbation"});
    Recorder recorder;
    integrate(model, recorder);
    const NodalField &middle = recorder.frames[2].u, &end = recorder.frames[4].u;
    for (std::size_t n = 0; n < end.size(); ++n) EXPECT_LT(distance(middle[n], end[n]), 1e-10) << n;
    const Vector force = recorder.rows.back().reactions.at("ground");
    EXPECT_NEAR(force[2], 200.0 * gravity, 1e-3);
    EXPECT_NEAR(force[0], -0.8 * coefficient * force[2], 1e-3);
  }
  for (const auto method : both_methods) {
    const double share = 2.0 * coefficient, time = 1.0;
    const Slab slab(method, share, 0.0, time);
    const Scene scene = slab.column.scene();
    const Model model(scene, {"tl-perturbation"});
    Recorder silent;
    const Motion motion = integrate(model, silent);
    const double speed = (share - coefficient) * gravity * time;
    EXPECT_NEAR(centre_of(motion.v, model.masses())[0], speed, 0.03 * speed);
  }
}

/// Bodies are pressed at random: by every shape, at speeds up to a tenth of the shear wave's, with friction
/// and without, by both methods, up to Poisson's ratio 0.49. Nothing is pushed through, and no energy is
/// gained.
TEST(Contact, presses_at_random) {
  using Shape = Obstacle::Shape;
  const long scenes = from_environment("SANDGLASS_SCENES", 100);
  RandomGeometry random(47);
  for (long number = 0; number < scenes; ++number) {
    const double ratio =
        std::array{0.0, 0.3, 0.45, 0.49, 0.4999}[static_cast<std::size_t>(random.uniform(0.0, 4.999))];
    Column block({1.0, 1.0, 0.5}, {6, 6, 3}, NeoHookean{.young_modulus = 1e4, .poisson_ratio = ratio});
    Case& d = block.description;
    d.quasi_static = false;
    d.displacements = {{"foot", {}}};
    Obstacle tool{.label = "tool", .set = "top"};
    tool.shape = static_cast<Shape>(static_cast<int>(random.uniform(0.0, 5.999)));
    tool.radius = random.uniform(0.2, 0.4);  // smaller ones may pass between nodes
    tool.point = {random.uniform(0.3, 0.7), random.uniform(0.3, 0.7), 0.51 + tool.radius};
    if (tool.shape == Shape::plane) tool.point[2] = 0.51, tool.normal = {0.0, 0.0, -1.0};
    if (tool.shape == Shape::box) {
      tool.half_sizes = {random.uniform(0.1, 0.3), random.uniform(0.1, 0.3), 0.2};
      tool.point[2] = 0.71;
    }
    if (tool.shape == Shape::ellipsoid)
      tool.half_sizes = {random.uniform(0.2, 0.4), random.uniform(0.2, 0.4), tool.radius};
    if (tool.shape == Shape::capsule || tool.shape == Shape::cylinder)
      tool.end = {tool.point[0] + random.uniform(0.1, 0.4), tool.point[1] + random.uniform(-0.4, 0.4),
                  tool.point[2]};
    if (tool.shape == Shape::plane || tool.shape == Shape::box || tool.shape == Shape::ellipsoid)
      tool.radius = 0.0;
    tool.friction = random.uniform(-0.5, 0.5) > 0.0 ? random.uniform(0.1, 0.8) : 0.0;
    tool.method = random.uniform(-1.0, 1.0) > 0.0 ? Obstacle::Method::penalty : Obstacle::Method::kinematic;
    tool.displacement = {random.uniform(-0.05, 0.05), 0.0, -random.uniform(0.06, 0.12)};
    d.forces.of<Obstacle>() = {tool};
    const double waves = std::sqrt(1e4 / 1000.0 / 3.0);
    d.dynamics.duration = 0.12 / (waves * random.uniform(0.01, 0.1));
    d.dynamics.check_interval = 10;
    const std::string what =
        fmt::format("scene {}: shape {}, method {}, friction {:.2f}, nu {}", number,
                    static_cast<int>(tool.shape), static_cast<int>(tool.method), tool.friction, ratio);
    const Scene scene = block.scene();
    Recorder recorder;
    try {
      integrate(Model(scene, {"tl-perturbation"}), recorder);
    } catch (const std::exception& error) {
      ADD_FAILURE() << what << ": " << error.what();
      continue;
    }
    double largest = 0.0, gained = 0.0, depth = 0.0;
    for (const HistoryRow& row : recorder.rows) {
      largest = std::max(largest, total_energy(row));
      gained = std::max(gained, total_energy(row) - row.external_work);
      depth = std::max(depth, row.depth);
    }
    EXPECT_GT(largest, 0.0) << what;
    EXPECT_LT(gained, 0.02 * largest) << what;
    EXPECT_LT(depth, 0.5 / 6.0) << what;
  }
}

/// A run that is resumed from any checkpoint ends with the same bits, anchors of friction included.
TEST(Contact, resumes_with_the_same_bits) {
  const auto expect_same = [](const Scene& scene, const auto& solve) {
    const Model model(scene, {"tl-perturbation"});
    KeepingRecorder whole;
    const NodalField answer = solve(model, whole, nullptr);
    ASSERT_GT(whole.kept().size(), 2U);
    for (const RunSoFar& kept : whole.kept()) {
      KeepingRecorder resumed(kept);
      const NodalField u = solve(model, resumed, &kept.point);
      EXPECT_EQ(u, answer);
      EXPECT_EQ(resumed.run().history.size(), whole.run().history.size());
      EXPECT_EQ(resumed.run().history.back().friction, whole.run().history.back().friction);
      EXPECT_EQ(resumed.run().history.back().external_work, whole.run().history.back().external_work);
    }
  };
  for (const auto method : both_methods) {
    Slab slab(method, 2.0 * coefficient, 0.5, 0.2);
    slab.column.description.dynamics.check_interval = 10;
    expect_same(slab.column.scene(), [](const Model& model, Observer& observer, const Checkpoint* from) {
      return integrate(model, observer, from).u;
    });
  }
  Column block({1.0, 1.0, 0.5}, {6, 6, 3}, NeoHookean{.young_modulus = 1e4, .poisson_ratio = 0.4});
  block.description.displacements = {{"foot", {}}};
  block.description.relaxation.levels = 3;
  Obstacle tool{.label = "tool", .set = "top", .shape = Obstacle::Shape::sphere, .point = {0.5, 0.5, 0.81}};
  tool.radius = 0.3;
  tool.displacement = {0.0, 0.0, -0.1};
  block.description.forces.of<Obstacle>() = {tool};
  expect_same(block.scene(), [](const Model& model, Observer& observer, const Checkpoint* from) {
    return relax(model, observer, from).u;
  });
}

}  // namespace
}  // namespace sandglass::verification::contact_motion_test
