/// Central differences: frequencies, order, time stamps, momentum and energy.

#include <gtest/gtest.h>

#include "mesh/hexahedron.hpp"
#include "solve/central_difference.hpp"
#include "solve/stable_step.hpp"
#include "support/derivatives.hpp"
#include "support/pair_test.hpp"
#include "support/random_hexahedra.hpp"
#include "support/scenes.hpp"

namespace sandglass::verification::dynamics_test {
namespace {

constexpr double density = 1000.0;

DynamicsSettings settings(double duration, double time_step) {
  DynamicsSettings chosen;
  chosen.duration = duration;
  chosen.time_step = time_step;
  chosen.check_interval = 1;
  chosen.frames = 1;
  return chosen;
}

/// One cube on three planes of symmetry with an initial outward velocity `speed` along all axes: it breathes,
/// u_i = q X_i / h, with the same mass rho h^3 / 8 at four nodes for each of the three directions.
Scene breathing_cube(const AnyLaw& law, double h, double speed) {
  Case scene = plain_case(law, density);
  scene.quasi_static = false;
  scene.velocities = {{.value = {speed, speed, speed}}};
  const Mesh mesh = box({h, h, h}, {1, 1, 1});
  NodeSets sets;
  for (std::size_t i = 0; i < 3; ++i) {
    const std::string name = std::string("plane ") + "xyz"[i];
    sets[name] = nodes_where(mesh.points, [i](const Vector& X) { return X[i] == 0.0; });
    ImposedDisplacement held{name, {}, {}};
    held.components[i] = true;
    scene.displacements.push_back(held);
  }
  return make_scene(scene, mesh, sets);
}

/// Lattice points are numbered with x fastest, so the free corner of a single cube comes last.
constexpr std::size_t corner = 7;

class DynamicsTest : public PairTest {
 protected:
  const double load = bearable_load(law());
};

INSTANTIATE_TEST_SUITE_P(, DynamicsTest, each_of_pairs(PairsOf<SteppedMethods>{}), pair_label);

/// A small breathing oscillation has omega^2 = 6 K / (rho h^2): the force V 3 K (q/h) / (4 h) on the mass rho
/// V / 8. Central differences follow it exactly at their own frequency, sin(phi / 2) = omega dt / 2: with
/// u(0) = 0, u_n = v0 dt sin(n phi) / sin(phi), and the velocity AT THE SAME TIME is v_n = v0 cos(n phi). A
/// wrong lumped mass changes phi; a velocity that is half a step or a step late changes the phase.
TEST_P(DynamicsTest, one_element_oscillates_with_its_frequency) {
  const double h = 0.02;
  const double speed = 1e-6;  // amplitude / h <= 1e-5: nonlinearity changes less than 1e-4 of the answer
  const AnyLaw law = this->law();
  Scene scene = breathing_cube(law, h, speed);
  const double omega = std::sqrt(6 * bulk_modulus_of(law) / (density * h * h));
  const double dt = 0.3 / omega;
  scene.settings.dynamics = settings(40 * dt, dt);
  scene.settings.dynamics.frames = 1000;  // more than there are steps: one frame per step
  const Model model(scene, choice());
  Recorder recorder;
  const Motion motion = integrate(model, recorder);
  const double phi = 2 * std::asin(omega * dt / 2);
  ASSERT_GE(recorder.frames.size(), 40U);
  for (const auto& frame : recorder.frames) {
    const double n = std::round(frame.time / dt);
    const double u = speed * dt * std::sin(n * phi) / std::sin(phi);
    for (std::size_t i = 0; i < 3; ++i) {
      EXPECT_NEAR(frame.u[corner][i], u, 1e-3 * speed / omega) << "step " << n;
      EXPECT_NEAR(frame.v[corner][i], speed * std::cos(n * phi), 1e-3 * speed) << "step " << n;
    }
  }
  EXPECT_EQ(motion.u, recorder.frames.back().u);
  EXPECT_EQ(motion.v, recorder.frames.back().v);
  EXPECT_EQ(motion.time, recorder.frames.back().time);
}

/// Displacements at times between steps, with omega dt = 0.3, come from a cubic through the motion, which is
/// (omega dt)^4 / 384 = 2e-5 of the amplitude off. A straight line would be a hundredth off, a step's delay
/// three tenths. The last step is a little longer than the others, as rounding or a user may have it.
TEST_P(DynamicsTest, reports_displacements_at_any_time) {
  struct Asking final : Observer {
    double next_sample() const override { return seen.size() < times.size() ? times[seen.size()] : 1e9; }
    void sample(const NodalField& u) override { seen.push_back(u[corner]); }
    std::vector<double> times;
    std::vector<Vector> seen;
  } asking;
  const double h = 0.02, speed = 1e-6;
  const AnyLaw law = this->law();
  Scene scene = breathing_cube(law, h, speed);
  const double omega = std::sqrt(6 * bulk_modulus_of(law) / (density * h * h));
  const double dt = 0.3 / omega;
  const double last = 20.0 + 1e-7;
  scene.settings.dynamics = settings(last * dt, dt);
  for (const double n : {0.4, 0.7, 3.0, 7.5, 12.25, 12.75, last}) asking.times.push_back(n * dt);
  integrate(Model(scene, choice()), asking);
  ASSERT_EQ(asking.seen.size(), asking.times.size());
  const double phi = 2 * std::asin(omega * dt / 2);
  for (std::size_t n = 0; n < asking.times.size(); ++n) {
    const double u = speed * dt * std::sin(phi * asking.times[n] / dt) / std::sin(phi);
    EXPECT_NEAR(asking.seen[n][0], u, 1e-3 * speed / omega) << "time " << n;
  }
}

/// The same cube with a large amplitude obeys one nonlinear equation, 12 m q'' = -dW/dq with W = V W(q/h I),
/// solved here to roundoff with Runge-Kutta. Displacement and velocity converge to it with the square of the
/// step.
TEST_P(DynamicsTest, converges_with_second_order_in_displacement_and_velocity) {
  const double h = 0.02;
  const AnyLaw law = this->law();
  const double omega = std::sqrt(6 * bulk_modulus_of(law) / (density * h * h));
  const double speed = 0.15 * h * omega;
  const double V = h * h * h;
  const auto acceleration = [&](double q) {
    const Tensor<D> H = D(q / h, 1.0 / h) * identity<D>();
    return -V * exact_energy(method.is_linear, law, H).slope / (12 * density * V / 8);
  };
  const double duration = 7.0 / omega;
  double q = 0.0;
  double v = speed;
  const int fine = 20000;
  const double s = duration / fine;  // fourth order: (omega s)^4 = 1e-14
  for (int n = 0; n < fine; ++n) {
    const double v2 = v + s / 2 * acceleration(q);
    const double a2 = acceleration(q + s / 2 * v);
    const double v3 = v + s / 2 * a2;
    const double a3 = acceleration(q + s / 2 * v2);
    const double a4 = acceleration(q + s * v3);
    const double a1 = acceleration(q);
    q += s / 6 * (v + 2 * v2 + 2 * v3 + v + s * a3);
    v += s / 6 * (a1 + 2 * a2 + 2 * a3 + a4);
  }
  std::array<double, 3> error_u{};
  std::array<double, 3> error_v{};
  for (std::size_t level = 0; level < 3; ++level) {
    const int steps = 64 << level;
    Scene scene = breathing_cube(law, h, speed);
    scene.settings.dynamics = settings(duration, duration / steps);
    const Model model(scene, choice());
    Observer silent;
    const Motion motion = integrate(model, silent);
    ASSERT_EQ(motion.steps, steps);
    error_u[level] = std::abs(motion.u[corner][0] - q);
    error_v[level] = std::abs(motion.v[corner][0] - v);
  }
  for (std::size_t level = 0; level < 2; ++level) {
    EXPECT_NEAR(error_u[level] / error_u[level + 1], 4.0, 0.5);
    EXPECT_NEAR(error_v[level] / error_v[level + 1], 4.0, 0.5);
  }
}

/// A free body keeps its velocity: u = v t, up to the roundoff of summed steps.
TEST_P(DynamicsTest, free_body_moves_uniformly) {
  Case description = plain_case(this->law(), density);
  description.quasi_static = false;
  const Vector velocity{0.3, -0.2, 0.1};
  description.velocities = {{.value = velocity}};
  description.dynamics.duration = 0.5;
  const Scene scene = make_scene(description, box({0.1, 0.1, 0.2}, {2, 2, 3}));
  const Model model(scene, choice());
  Recorder recorder;
  const Motion motion = integrate(model, recorder);
  EXPECT_NEAR(motion.time, 0.5, 1e-12);  // the last step ends at the requested time
  for (std::size_t n = 0; n < motion.u.size(); ++n) {
    for (std::size_t i = 0; i < 3; ++i) {
      EXPECT_NEAR(motion.v[n][i], velocity[i], 1e-10);
      EXPECT_NEAR(motion.u[n][i], velocity[i] * motion.time, 1e-11);
    }
  }
  for (const auto& row : recorder.rows) {
    EXPECT_NEAR(row.kinetic, 0.5 * density * 0.002 * 0.14, 1e-10);
    EXPECT_EQ(row.external_work, 0.0);
  }
}

/// A block held at its foot, moving sideways at first, exchanges kinetic and strain energy. Their sum is
/// constant up to a fraction of (omega dt)^2, without drift, and closer with half the step.
TEST_P(DynamicsTest, energy_is_conserved_to_second_order) {
  const auto largest_change = [&](double fraction) {
    Case description = plain_case(this->law(), density);
    description.quasi_static = false;
    description.velocities = {{.value = {0.4 * load, 0.1 * load, 0.0}}};
    const Mesh mesh = box({0.1, 0.1, 0.2}, {2, 2, 4});
    const NodeSets sets{{"foot", nodes_where(mesh.points, [](const Vector& X) { return X[2] == 0.0; })}};
    description.displacements.push_back({"foot", {}});
    Scene scene = make_scene(description, mesh, sets);
    const Model probe(scene, choice());
    const double dt = fraction * stable_step(probe, NodalField(mesh.points.size())).step;
    scene.settings.dynamics = settings(0.6, dt);
    const Model model(scene, choice());
    Recorder recorder;
    integrate(model, recorder);
    const double start = total_energy(recorder.rows.front());
    double change = 0.0;
    double least_kinetic = start;
    for (const auto& row : recorder.rows) {
      change = std::max(change, std::abs(total_energy(row) / start - 1.0));
      least_kinetic = std::min(least_kinetic, row.kinetic);
    }
    EXPECT_LT(least_kinetic, 0.5 * start);  // energy does move to strain and back
    return change;
  };
  const double coarse = largest_change(0.4);
  const double fine = largest_change(0.2);
  // (omega dt)^2 is .01 to .1; second-order terms partly cancel, so the ratio may be below 4.
  EXPECT_LT(coarse, 2e-3);
  EXPECT_LT(fine, 6e-4);
  EXPECT_GT(coarse / fine, 1.9);
}

/// The work of the driven nodes is the body's energy, kinetic + strain + hourglass, to second order.
TEST_P(DynamicsTest, work_of_driven_nodes_balances_energies) {
  const auto imbalance = [&](double fraction) {
    Case description = plain_case(this->law(), density);
    description.quasi_static = false;
    const Mesh mesh = box({0.1, 0.1, 0.2}, {2, 2, 4});
    const NodeSets sets{{"foot", nodes_where(mesh.points, [](const Vector& X) { return X[2] == 0.0; })},
                        {"head", nodes_where(mesh.points, [](const Vector& X) { return X[2] > 0.19; })}};
    description.displacements = {{"foot", {}}, {"head", {0.03 * load, 0.0, 0.05 * load}}};
    Scene scene = make_scene(description, mesh, sets);
    const Model probe(scene, choice());
    const double dt = fraction * stable_step(probe, NodalField(mesh.points.size())).step;
    scene.settings.dynamics = settings(0.15, dt);
    scene.settings.dynamics.ramp_time = 0.1;  // fast enough to cause waves
    const Model model(scene, choice());
    Recorder recorder;
    integrate(model, recorder);
    return energy_imbalance(recorder.rows);
  };
  const double coarse = imbalance(0.4);
  const double fine = imbalance(0.2);
  // (omega dt)^2 is .01 to .1; second-order terms partly cancel, so the ratio may be below 4.
  EXPECT_LT(coarse, 2e-3);
  EXPECT_LT(fine, 6e-4);
  EXPECT_GT(coarse / fine, 1.9);
}

/// A free body with damping c slows down as exp(-c t); displacement and velocity are of second order.
TEST(Dynamics, damping_slows_a_free_body_with_second_order) {
  const double damping = 2.0;
  std::array<double, 2> error_u{};
  std::array<double, 2> error_v{};
  for (std::size_t level = 0; level < 2; ++level) {
    Case description = plain_case(sample_law<NeoHookean>(0.45), density);
    description.quasi_static = false;
    description.velocities = {{.value = {1.0, 0.0, 0.0}}};
    const int steps = 32 << level;
    description.dynamics = settings(1.0, 1.0 / steps);
    description.dynamics.damping = damping;
    const Scene scene = make_scene(description, box({1.0, 1.0, 1.0}, {1, 1, 1}));
    const Model model(scene, {"tl-perturbation", {}});
    Observer silent;
    const Motion motion = integrate(model, silent);
    ASSERT_EQ(motion.steps, steps);
    error_u[level] = std::abs(motion.u[0][0] - (1 - std::exp(-damping)) / damping);
    error_v[level] = std::abs(motion.v[0][0] - std::exp(-damping));
  }
  EXPECT_NEAR(error_u[0] / error_u[1], 4.0, 0.5);
  EXPECT_NEAR(error_v[0] / error_v[1], 4.0, 0.5);
}

/// Damping of more than the inverse of the stable step shortens steps, so that a free body slows down and
/// does not turn around: it stops after v / c. With the stable step it went back and forth.
TEST(Dynamics, strong_damping_limits_the_step) {
  Case description = plain_case(sample_law<NeoHookean>(0.45), density);
  description.quasi_static = false;
  description.velocities = {{.value = {1.0, 0.0, 0.0}}};
  const double damping = 5000.0;
  description.dynamics = {
      .duration = 20.0 / damping, .damping = damping, .check_interval = 1, .frames = 1000};
  const Scene scene = make_scene(description, box({1.0, 1.0, 1.0}, {1, 1, 1}));
  Recorder recorder;
  const Motion motion = integrate(Model(scene, {"tl-perturbation", {}}), recorder);
  EXPECT_NEAR(motion.u[0][0], 1.0 / damping, 0.1 / damping);  // steps are as long as 1 / c
  for (const Frame& frame : recorder.frames) EXPECT_GE(frame.v[0][0], 0.0) << frame.time;
}

/// Damping takes energy from free nodes: a block whose foot is driven, as most of a stiff one moves, spends
/// the work of its supports on strain, motion and damping. Counted with the driven nodes, the losses were a
/// third too large.
TEST(Dynamics, damping_takes_no_energy_from_driven_nodes) {
  Case description = plain_case(sample_law<NeoHookean>(0.45), density);
  description.quasi_static = false;
  const Mesh mesh = box({0.1, 0.1, 0.1}, {2, 2, 2});
  const NodeSets sets{{"foot", nodes_where(mesh.points, [](const Vector& X) { return X[2] < 0.06; })}};
  description.displacements = {{"foot", {0.0, 0.2, 0.0}}};
  description.dynamics = {.duration = 0.5, .damping = 20.0, .check_interval = 1};
  const Scene scene = make_scene(description, mesh, sets);
  Recorder recorder;
  integrate(Model(scene, {"tl-full", {}}), recorder);
  EXPECT_GT(recorder.rows.back().damping, 0.5 * recorder.rows.back().external_work);
  EXPECT_LT(energy_imbalance(recorder.rows), 0.01);
}

/// Driven nodes have the velocity of the loading curve at the time of the frame.
TEST(Dynamics, velocity_of_driven_nodes_is_that_of_the_loading_curve) {
  Case description = plain_case(sample_law<NeoHookean>(0.45), density);
  description.quasi_static = false;
  const Mesh mesh = box({0.1, 0.1, 0.1}, {1, 1, 1});
  const NodeSets sets{{"all", nodes_where(mesh.points, [](const Vector&) { return true; })}};
  description.displacements = {{"all", {0.0, 0.02, 0.0}}};
  description.dynamics.duration = 0.2;
  description.dynamics.frames = 1000;
  description.dynamics.check_interval = 1;
  const Scene scene = make_scene(description, mesh, sets);
  const Model model(scene, {"tl-full", {}});
  Recorder recorder;
  integrate(model, recorder);
  ASSERT_GT(recorder.frames.size(), 10U);
  EXPECT_EQ(recorder.frames.front().time, 0.0);
  for (const auto& frame : recorder.frames) {
    const double t = std::min(frame.time / 0.2, 1.0);
    const double s = t * t * t * (10 - 15 * t + 6 * t * t);    // eq. 15
    const double rate = 30 * t * t * (1 - t) * (1 - t) / 0.2;  // its derivative
    EXPECT_NEAR(frame.u[3][1], 0.02 * s, 1e-15);
    EXPECT_NEAR(frame.v[3][1], 0.02 * rate, 1e-13);
  }
}

}  // namespace
}  // namespace sandglass::verification::dynamics_test
