/// Motions against SUNDIALS: the same system in space, integrated in time to ten digits by another program.

#include <gtest/gtest.h>

#include <numbers>

#include "io/case_file.hpp"
#include "solve/central_difference.hpp"
#include "solve/stable_step.hpp"
#include "support/random_hexahedra.hpp"
#include "support/scenes.hpp"
#include "support/semi_discrete.hpp"
#include "support/typed_lists.hpp"

namespace sandglass::verification::time_oracle_test {
namespace {

constexpr double density = 1000.0;
constexpr double oracle_tolerance = 1e-10;

template <class Method>
class TimeOracleTest : public ::testing::Test {
 protected:
  /// At this accuracy, elements of an adaptive method keep their levels.
  static MethodChoice choice() { return {.method = std::string(Method::name), .accuracy = 1.0}; }
};

TYPED_TEST_SUITE(TimeOracleTest, detail::AsTestTypes<MovingMethods>::type, EntryName);

double norm(const std::vector<double>& a) {
  double square = 0.0;
  for (const double x : a) square += x * x;
  return std::sqrt(square);
}

std::vector<double> difference(std::vector<double> a, const std::vector<double>& b) {
  for (std::size_t k = 0; k < a.size(); ++k) a[k] -= b[k];
  return a;
}

/// A block of distorted elements on its foot: the head is driven sideways and up, the middle starts with a
/// velocity and a spin, and a force pulls at a side. It uses every feature of a dynamic case, all values
/// scaled by `size`.
Scene shaken_block(const NeoHookean& law, double damping, double size) {
  Case description = plain_case(law, density);
  description.quasi_static = false;
  Mesh mesh = box({0.1, 0.1, 0.1}, {2, 2, 2});
  const NodeSets sets{{"foot", nodes_where(mesh.points, [](const Vector& X) { return X[2] == 0.0; })},
                      {"head", nodes_where(mesh.points, [](const Vector& X) { return X[2] > 0.09; })},
                      {"side", nodes_where(mesh.points, [](const Vector& X) { return X[0] > 0.09; })}};
  RandomGeometry random(11);
  for (auto& X : mesh.points) {
    for (auto& x : X) x += random.uniform(-0.006, 0.006);
  }
  description.displacements = {{"foot", {}}, {"head", {0.02 * size, 0.0, 0.01 * size}}};
  description.forces.of<DeadForce>() = {{"side", {0.0, 2.0 * size, 0.0}}};
  description.velocities = {
      {.value = {0.1 * size, 0.2 * size, -0.1 * size}, .spin = {2.0 * size, 0.0, 5.0 * size}}};
  description.dynamics.damping = damping;
  description.dynamics.check_interval = 1000000;
  description.dynamics.frames = 1;
  return make_scene(description, mesh, sets);
}

/// Distances to the oracle's motion with steps dt, dt/2 and dt/4, and their remainder without the linear
/// part: with e = A dt + B dt^2 + ..., 2 e(dt/2) - e(dt) = -B dt^2 / 2 + ...
class Convergence {
 public:
  void add(std::vector<double> error) { errors_.push_back(std::move(error)); }

  /// The order of the error between the two finest steps.
  double order() const { return std::log2(norm(errors_[1]) / norm(errors_[2])); }

  /// The order of the error without its linear part.
  double order_beyond_first() const {
    return std::log2(norm(difference(twice(errors_[1]), errors_[0])) /
                     norm(difference(twice(errors_[2]), errors_[1])));
  }

  double finest() const { return norm(errors_[2]); }

 private:
  static std::vector<double> twice(std::vector<double> a) {
    for (double& x : a) x *= 2.0;
    return a;
  }

  std::vector<std::vector<double>> errors_;
};

/// The step is halved twice. The scheme is symmetric in time, so its error has only even powers of the step;
/// the second power is the phase error (omega dt)^2 / 24 per radian. Over 30 radians of the fastest mode
/// possible, 2 / dt_stable, with omega dt = 1/8 in the middle run, it is .02 rad of that mode, and the next
/// terms are smaller than the first by as much: they change the order by log2(1 + 3/4 * .02) = .022 at most
/// where nothing cancels. The slow modes that carry most of the motion are closer to 2.
///
/// Methods with memory integrate their history with the geometry at the end of the step, as Updated
/// Lagrangian codes do, and viscous control uses velocities half a step old: both are of first order by
/// design, with a small constant. Their limit is the same system with the history integrated in time; they
/// must reach it, and the error without its linear part must be of second order. Here the third power
/// matters: log2(1 + dt C / B) is .1 where it is a fifteenth of the second. The linear part of a history is
/// of the order of strain: it vanishes in a motion of a ten-thousandth, where the order is 2.
TYPED_TEST(TimeOracleTest, converges_to_the_semi_discrete_motion) {
  struct Kind {
    std::string name;
    double damping;  // 1/s
    double size;
  };
  const NeoHookean law = sample_law<NeoHookean>(0.45);
  for (const auto& kind : {Kind{"", 0.0, 1.0}, Kind{" damped", 15.0, 1.0}, Kind{" small", 15.0, 1e-4}}) {
    SCOPED_TRACE("motion:" + kind.name);
    Scene scene = shaken_block(law, kind.damping, kind.size);
    const Model probe(scene, this->choice());
    const double frequency = 2.0 / stable_step(probe, NodalField(scene.mesh.points.size())).step;
    scene.settings.dynamics.duration = 30.0 / frequency;
    const SemiDiscrete<TypeParam, NeoHookean> exact(scene, law);
    const MotionAt reference = exact.solved(oracle_tolerance, 0.01 * kind.size, frequency);
    const MotionAt finer = exact.solved(1e-2 * oracle_tolerance, 0.01 * kind.size, frequency);
    Convergence u;
    Convergence v;
    for (const int steps : {120, 240, 480}) {
      scene.settings.dynamics.time_step = scene.settings.dynamics.duration / steps;
      Observer silent;
      const Motion motion = integrate(Model(scene, this->choice()), silent);
      ASSERT_EQ(motion.steps, steps);
      u.add(difference(flat(motion.u), reference.u));
      v.add(difference(flat(motion.v), reference.v));
    }
    // The oracle's own error, estimated with a hundredth of its tolerance, is negligible.
    EXPECT_LT(norm(difference(reference.u, finer.u)), 1e-4 * u.finest());
    EXPECT_LT(norm(difference(reference.v, finer.v)), 1e-4 * v.finest());
    EXPECT_LT(u.finest(), 1e-3 * norm(reference.u));
    EXPECT_LT(v.finest(), 1e-2 * norm(reference.v));
    const bool linear_part = DampsOnly<typename TypeParam::Hourglass> ||
                             (!detail::path_independent<TypeParam> && kind.size == 1.0);
    if (linear_part) {
      EXPECT_GT(u.order(), 1.0 - 0.1);
      EXPECT_GT(v.order(), 1.0 - 0.1);
      EXPECT_NEAR(u.order_beyond_first(), 2.0, 0.1);
      EXPECT_NEAR(v.order_beyond_first(), 2.0, 0.1);
    } else {
      EXPECT_NEAR(u.order(), 2.0, 0.022);
      EXPECT_NEAR(v.order(), 2.0, 0.022);
    }
    this->RecordProperty("order of u" + kind.name, fmt::format("{:.4f}", u.order()));
    this->RecordProperty("order of v" + kind.name, fmt::format("{:.4f}", v.order()));
  }
}

/// cases/bar-wave.toml, or the same bar with another mesh.
Case bar_wave(const std::array<int, 3>& elements) {
  Case description = read_case_file(std::filesystem::path(SANDGLASS_SOURCE) / "cases" / "bar-wave.toml");
  std::get<BoxMesh>(std::get<AnyGenerator>(description.mesh)).elements = elements;
  return description;
}

/// The parameters of the bar's closed form, from the case.
struct Bar {
  explicit Bar(const Case& description)
      : law(std::get<NeoHookean>(description.materials.front().law)),
        box(std::get<BoxMesh>(std::get<AnyGenerator>(description.mesh))),
        speed(description.velocities.front().value[2]) {
    const double wave_speed = std::sqrt(law.young_modulus / description.materials.front().density);
    const double h = box.size[2] / box.elements[2];
    omega = std::numbers::pi * wave_speed / box.size[2];
    omega_of_mesh = 2 * wave_speed / h * std::sin(std::numbers::pi * h / (2 * box.size[2]));
    strain = speed / wave_speed;
  }

  /// How much slower the mesh is than the bar, to lowest order.
  double slowness() const { return std::pow(std::numbers::pi / box.elements[2], 2) / 24; }

  NeoHookean law;
  BoxMesh box;
  double speed;          ///< m/s, amplitude
  double omega;          ///< rad/s, of the bar
  double omega_of_mesh;  ///< rad/s, of a chain of masses and springs: cos(pi z / L) is its mode exactly
  double strain;         ///< largest
};

/// The part of a field in the bar's mode cos(pi z / L): its amplitude by the masses, and the norm of the
/// remainder per node.
struct Modal {
  double amplitude;
  double rest;
};
Modal in_mode(const Scene& scene, double length, const std::vector<double>& masses,
              std::vector<double> field) {
  const auto mode = [&](std::size_t n) {
    return std::cos(std::numbers::pi * scene.mesh.points[n][2] / length);
  };
  double product = 0.0, square = 0.0;
  for (std::size_t n = 0; n < masses.size(); ++n) {
    product += masses[n] * mode(n) * field[3 * n + 2];
    square += masses[n] * mode(n) * mode(n);
  }
  for (std::size_t n = 0; n < masses.size(); ++n) field[3 * n + 2] -= product / square * mode(n);
  return {product / square, norm(field) / std::sqrt(static_cast<double>(masses.size()))};
}

/// One period of the bar. In space: a mesh of equal elements is a chain of masses and springs with the mode
/// cos(pi z / L) and omega_h = 2 c / h sin(pi h / 2 L), slow by s = (pi h / L)^2 / 24. In time: central
/// differences follow a mode with sin(phi / 2) = omega_h dt / 2 per step,
///   u_n = v0 dt sin(n phi) / sin(phi),   v_n = v0 cos(n phi),
/// fast by (omega dt)^2 / 24, and the energy of u_n and of the product of v_n-1/2 and v_n+1/2 is constant.
/// SUNDIALS on the same mesh separates the two errors. Nonlinearity changes amplitudes by the square of the
/// strain, 3e-11, ten times which is allowed, and the rest of the field and the energy by the strain itself.
/// The phase of u and v is off by 3 s of itself, since the amplitude of u has an error of the same order.
///
/// If pressures are averaged over nodes the bar is no chain, since pressures of neighbours push its sides;
/// then the error in space must still be of second order, and the error in time as before.
TYPED_TEST(TimeOracleTest, bar_wave_has_the_errors_of_theory) {
  constexpr bool chain = !FormulationOf<TypeParam, NeoHookean>::averages_over_nodes;
  std::array<double, 2> lag{};  // of the mesh, rad
  for (std::size_t level = 0; level < 2; ++level) {
    const int fineness = 1 << level;
    const Case description = bar_wave({fineness, fineness, 20 * fineness});
    Scene scene = read_scene(description);
    const Bar bar(description);
    auto& dynamics = scene.settings.dynamics;
    ASSERT_NEAR(dynamics.duration, 2 * std::numbers::pi / bar.omega, 1e-12);
    const SemiDiscrete<TypeParam, NeoHookean> exact(scene, bar.law);
    const double amplitude = bar.speed / bar.omega;  // m
    const double second_order = 10 * bar.strain * bar.strain;
    const MotionAt oracle = exact.solved(oracle_tolerance, amplitude, bar.omega);
    const Modal u = in_mode(scene, bar.box.size[2], exact.masses(), oracle.u);
    const Modal v = in_mode(scene, bar.box.size[2], exact.masses(), oracle.v);
    lag[level] = -std::atan2(bar.omega * u.amplitude, v.amplitude);
    if (chain) {
      const double expected = (bar.omega - bar.omega_of_mesh) * dynamics.duration;
      EXPECT_NEAR(u.amplitude, -bar.speed / bar.omega_of_mesh * std::sin(expected), second_order * amplitude);
      EXPECT_NEAR(v.amplitude, bar.speed * std::cos(expected), second_order * bar.speed);
      EXPECT_LT(u.rest, bar.strain * amplitude);
      EXPECT_LT(v.rest, bar.strain * bar.speed);
    }
    const double omega = bar.omega - lag[level] / dynamics.duration;
    for (const int steps : {256, 512}) {
      dynamics.time_step = dynamics.duration / steps;
      dynamics.check_interval = 1;
      Recorder recorder;
      const Motion motion = integrate(Model(scene, this->choice()), recorder);
      ASSERT_EQ(motion.steps, steps);
      const Modal stepped_u = in_mode(scene, bar.box.size[2], exact.masses(), flat(motion.u));
      const Modal stepped_v = in_mode(scene, bar.box.size[2], exact.masses(), flat(motion.v));
      const double advance = lag[level] + std::atan2(bar.omega * stepped_u.amplitude, stepped_v.amplitude);
      const double constant = advance / (steps * std::pow(omega * dynamics.time_step, 3));
      EXPECT_NEAR(24 * constant, 1.0, 5 * bar.slowness());
      this->RecordProperty(fmt::format("phase error of {} steps over theory", steps),
                           fmt::format("{:.5f}", 24 * constant));
      if (!chain) continue;
      const double x = bar.omega_of_mesh * dynamics.time_step;
      const double phi = 2 * std::asin(x / 2);
      EXPECT_NEAR(stepped_u.amplitude, bar.speed * dynamics.time_step * std::sin(steps * phi) / std::sin(phi),
                  second_order * amplitude);
      EXPECT_NEAR(stepped_v.amplitude, bar.speed * std::cos(steps * phi), second_order * bar.speed);
      const double start = total_energy(recorder.rows.front());
      for (const auto& row : recorder.rows) EXPECT_NEAR(total_energy(row) / start, 1.0, bar.strain);
    }
  }
  EXPECT_NEAR(lag[0] / lag[1], 4.0, 0.2);
  this->RecordProperty("lag of 20 and 40 elements", fmt::format("{:.4e} {:.4e}", lag[0], lag[1]));
}

Vector cross(const Vector& a, const Vector& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

double size(const Vector& a) {
  return std::hypot(a[0], a[1], a[2]);
}

/// The conserved quantities of a body in free flight, and the sums of absolute values that scale roundoff.
struct Momenta {
  Vector linear{};   ///< kg m/s
  Vector angular{};  ///< kg m^2/s, about the origin
  double linear_size = 0.0;
  double angular_size = 0.0;
};

Momenta momenta(const std::vector<double>& masses, const NodalField& points, const Frame& frame) {
  Momenta sum;
  for (std::size_t n = 0; n < frame.u.size(); ++n) {
    Vector x;
    for (std::size_t i = 0; i < 3; ++i) x[i] = points[n][i] + frame.u[n][i];
    const Vector moment = cross(x, frame.v[n]);
    for (std::size_t i = 0; i < 3; ++i) {
      sum.linear[i] += masses[n] * frame.v[n][i];
      sum.angular[i] += masses[n] * moment[i];
    }
    sum.linear_size += masses[n] * size(frame.v[n]);
    sum.angular_size += masses[n] * size(x) * size(frame.v[n]);
  }
  return sum;
}

double distance(const Vector& a, const Vector& b) {
  return size({a[0] - b[0], a[1] - b[1], a[2] - b[2]});
}

/// A distorted block flies and spins, at half the stable step. The forces of an element sum to zero, and so
/// do their moments about current positions, so that central differences conserve two sums exactly: m
/// v(n-1/2), and m x(n) x v(n-1/2) = m x(n-1) x v(n-1/2). Between the half steps v(n) = v(n-1/2) + dt/2 a(n),
/// and the accelerations at n contribute nothing to either sum: the sums over a frame, with x and v at the
/// same time, equal the scheme's. Velocities at another time would make the second oscillate with the
/// vibration. What remains is roundoff of either sign: sums of absolute values times eps times the root of
/// the number of steps, times four for the roundings of a step and of these sums.
///
/// Updated Lagrangian methods conserve both too while they last: the turned history adds energy to a spinning
/// body in proportion to the step, until they fail after 10,000 to 25,000 of these steps.
TYPED_TEST(TimeOracleTest, spinning_block_keeps_its_momenta) {
  constexpr int steps = detail::path_independent<TypeParam> ? 100000 : 5000;
  const NeoHookean law = sample_law<NeoHookean>(0.45);
  Case description = plain_case(law, density);
  description.quasi_static = false;
  Mesh mesh = box({0.1, 0.08, 0.06}, {2, 2, 2});
  RandomGeometry random(5);
  for (auto& X : mesh.points) {
    for (auto& x : X) x += random.uniform(-0.004, 0.004);
  }
  description.velocities = {{.value = {0.01, -0.02, 0.015}}, {.spin = {1.0, 2.0, 3.0}}};
  description.dynamics.check_interval = 100;
  description.dynamics.frames = 100;
  Scene scene = make_scene(description, mesh);
  const Model probe(scene, this->choice());
  scene.settings.dynamics.time_step = 0.5 * stable_step(probe, NodalField(mesh.points.size())).step;
  scene.settings.dynamics.duration = steps * scene.settings.dynamics.time_step;
  const SemiDiscrete<TypeParam, NeoHookean> body(scene, law);
  Recorder recorder;
  const Motion motion = integrate(Model(scene, this->choice()), recorder);
  EXPECT_NEAR(static_cast<double>(motion.steps), steps, 1);  // the sum of this many steps is rounded
  const Momenta start = momenta(body.masses(), scene.mesh.points, recorder.frames.front());
  EXPECT_GT(size(start.angular), 0.0);
  const double roundoff = 4 * std::numeric_limits<double>::epsilon() * std::sqrt(steps);
  double linear_drift = 0.0;
  double angular_drift = 0.0;
  for (const auto& frame : recorder.frames) {
    const Momenta now = momenta(body.masses(), scene.mesh.points, frame);
    EXPECT_LT(distance(now.linear, start.linear), roundoff * now.linear_size);
    // Small-strain theory balances moments about the undeformed positions.
    if (!is_linear<TypeParam>) {
      EXPECT_LT(distance(now.angular, start.angular), roundoff * (start.angular_size + now.angular_size));
    }
    linear_drift = std::max(linear_drift, distance(now.linear, start.linear) / size(start.linear));
    angular_drift = std::max(angular_drift, distance(now.angular, start.angular) / size(start.angular));
  }
  this->RecordProperty("drift of linear momentum", fmt::format("{:.1e}", linear_drift));
  this->RecordProperty("drift of angular momentum", fmt::format("{:.1e}", angular_drift));
}

}  // namespace
}  // namespace sandglass::verification::time_oracle_test
