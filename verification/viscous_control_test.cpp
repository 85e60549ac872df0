/// Viscous hourglass control: the motions that it damps, the rate, and the motions that it does not affect.

#include <gtest/gtest.h>

#include "element/methods.hpp"
#include "solve/central_difference.hpp"
#include "support/random_hexahedra.hpp"
#include "support/sample_law.hpp"
#include "support/scenes.hpp"
#include "support/single_element.hpp"

namespace sandglass::verification::viscous_control_test {
namespace {

constexpr double eps = std::numeric_limits<double>::epsilon();
constexpr double density = 1050.0;
const NeoHookean law{.young_modulus = 3000.0, .poisson_ratio = 0.45};

using Kernel = FormulationOf<UlViscous, NeoHookean>;
using Uncontrolled = Formulation<UpdatedOnePoint, NoHourglassControl, NeoHookean>;

double wave_speed() {
  return std::sqrt(p_wave_modulus(law) / density);
}

/// A free cube with hourglass velocities s Gamma_a along one axis, stepped as in the scheme with velocities
/// half a step late: c = kappa/4 rho c_d h^2 gives forces 8 c s Gamma on masses rho h^3 / 8, a rate of 16
/// kappa c_d / h, so that each step leaves 1 - 16 kappa c_d dt / h of the velocity. Displacements of 1e-6
/// change the shape, and with it the rate, by as much.
TEST(ViscousControl, hourglass_velocities_decay_at_the_derived_rate) {
  const double h = 0.02;
  const NodalVectors<double> X = (0.5 * h) * corner_signs;
  const double mass = density * h * h * h / 8;
  const double dt = 0.05 * h / wave_speed();
  constexpr auto Gamma = hourglass_base_vectors();
  for (const double kappa : {0.05, 0.1, 0.4}) {
    for (int a = 0; a < 4; ++a) {
      SingleElement<Kernel, NeoHookean> element(X, law, {kappa, density});
      const double speed = 1e-6 * h / dt;
      NodalVectors<double> u{}, v{};
      for (int I = 0; I < 8; ++I) v(I, a % 3) = speed * Gamma(I, a);
      double expected = speed;
      for (int n = 0; n < 20; ++n) {
        u += dt * v;
        v = v - (dt / mass) * element.to(u, 1 / dt);
        expected *= 1 - 16 * kappa * wave_speed() * dt / h;
        for (int I = 0; I < 8; ++I) {
          EXPECT_NEAR(v(I, a % 3), expected * Gamma(I, a), 1e-4 * speed)
              << "kappa " << kappa << " step " << n;
        }
      }
      EXPECT_LT(expected, 0.7 * speed);  // the samples distinguish decay from none
    }
  }
}

/// `auto` is the published coefficient.
TEST(ViscousControl, coefficient_is_that_of_other_programs) {
  const NodalVectors<double> X = (0.5 * 0.02) * corner_signs;
  const auto by_choice = Kernel::precompute(X, law, {0.1, density});
  const auto by_default = Kernel::precompute(X, law, {std::nullopt, density});
  EXPECT_EQ(by_choice.hourglass.impedance, by_default.hourglass.impedance);
  EXPECT_NEAR(by_choice.hourglass.impedance, 0.025 * density * wave_speed(), 1e-12 * density * wave_speed());
}

/// Its power is -c |gamma^T v|^2, from the definitions: gamma and v of the current shape, rho_0 V_0 for rho
/// v. It is never positive, along any path.
TEST(ViscousControl, takes_energy_and_never_gives_any) {
  RandomGeometry random(31);
  for (int n = 0; n < 50; ++n) {
    const auto X = random.hexahedron();
    SingleElement<Kernel, NeoHookean> damped(X, law, {0.1, density});
    SingleElement<Uncontrolled, NeoHookean> free(X, law);
    NodalVectors<double> before{};
    const double dt = 1e-2;
    for (int step = 0; step < 5; ++step) {
      const auto u = random.displacements(X, 0.7, 1.4, 0.15);
      const auto v = (1 / dt) * (u - before);
      before = u;
      const auto x = X + u;
      const MeanGradient current = mean_gradient(x);
      const auto q = transpose(hourglass_shape_vectors(x, current.h)) * v;
      const auto resisting = damped.to(u, 1 / dt) - free.to(u, 1 / dt);
      const double c = 0.025 * wave_speed() * density / damped.mean_jacobian() *
                       std::cbrt(current.volume * current.volume);
      const double lost = c * double_dot(q, q);
      EXPECT_NEAR(double_dot(resisting, v) / lost, 1.0, 1e-7);
      EXPECT_EQ(damped.energy().hourglass, 0.0);
    }
  }
}

/// In static solutions there is nothing to damp: bit by bit the element without control.
TEST(ViscousControl, does_nothing_without_velocities) {
  RandomGeometry random(32);
  for (int n = 0; n < 20; ++n) {
    const auto X = random.hexahedron();
    const auto u = random.displacements(X, 0.7, 1.4, 0.15);
    SingleElement<Kernel, NeoHookean> damped(X, law, {0.1, density});
    SingleElement<Uncontrolled, NeoHookean> free(X, law);
    const auto f = free.to(u);
    EXPECT_LT(largest_entry(damped.to(u) - f), 16 * eps * largest_entry(f));
  }
}

/// Damping shortens the step: at the undamped limit the motion grows, within the damped limit it decays.
TEST(ViscousControl, stable_step_knows_of_the_damping) {
  const double h = 0.02;
  const double kappa = 0.3;
  const NodalVectors<double> X = (0.5 * h) * corner_signs;
  const double mass = density * h * h * h / 8;
  SingleElement<Uncontrolled, NeoHookean> free(X, law);
  SingleElement<Kernel, NeoHookean> damped(X, law, {kappa, density});
  free.to({});
  damped.to({});
  const auto amplitude_after = [&](double dt) {
    SingleElement<Kernel, NeoHookean> element(X, law, {kappa, density});
    NodalVectors<double> u{}, v{};
    for (int I = 0; I < 8; ++I) v(I, 0) = 1e-9 * h / dt * hourglass_base_vectors()(I, 3);
    for (int n = 0; n < 30; ++n) {
      u += dt * v;
      v = v - (dt / mass) * element.to(u, 1 / dt);
    }
    return largest_entry(v) * dt / h;
  };
  EXPECT_LT(amplitude_after(2 * std::sqrt(mass / damped.stiffness_bound())), 1e-9);
  EXPECT_GT(amplitude_after(2 * std::sqrt(mass / free.stiffness_bound())), 1e-8);
}

/// A block with a sideways initial velocity, as in the tests of dynamics: the damper dissipates, so that
/// kinetic plus strain energy never exceeds earlier values by more than the oscillation of (omega dt)^2 of a
/// conserving method, and in the end some is gone.
TEST(ViscousControl, thrown_block_loses_energy) {
  Case description = plain_case(law, density);
  description.quasi_static = false;
  description.velocities = {{.value = {0.4, 0.1, 0.0}}};
  const Mesh mesh = box({0.1, 0.1, 0.2}, {2, 2, 4});
  const NodeSets sets{{"foot", nodes_where(mesh.points, [](const Vector& X) { return X[2] == 0.0; })}};
  description.displacements.push_back({"foot", {}});
  description.dynamics.duration = 0.6;
  description.dynamics.step_fraction = 0.2;
  description.dynamics.check_interval = 1;
  const Scene scene = make_scene(description, mesh, sets);
  const auto end_over_start = [&](double kappa) {
    const Model model(scene, {std::string(UlViscous::name), kappa});
    Recorder recorder;
    integrate(model, recorder);
    const double start = total_energy(recorder.rows.front());
    double least = start;
    for (const auto& row : recorder.rows) {
      EXPECT_EQ(row.hourglass, 0.0);
      EXPECT_LT(total_energy(row), least + 0.01 * start);
      least = std::min(least, total_energy(row));
    }
    return total_energy(recorder.rows.back()) / start;
  };
  EXPECT_LT(end_over_start(0.1), 0.95);
}

}  // namespace
}  // namespace sandglass::verification::viscous_control_test
