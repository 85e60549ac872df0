/// Loads as derivatives of their potential, and the balance of their work and the energies of a motion.

#include <gtest/gtest.h>

#include <algorithm>

#include "solve/central_difference.hpp"
#include "solve/loads.hpp"
#include "support/obstacles.hpp"
#include "support/random_hexahedra.hpp"
#include "support/scenes.hpp"

namespace sandglass::verification::load_energy_test {
namespace {

/// A body with loads of every kind, a pressure on its whole surface, and springs of both kinds; displaced at
/// random.
struct Loaded {
  Mesh mesh = box({1.0, 2.0, 1.5}, {2, 2, 2});
  Scene scene;
  Model model;
  const InternalForce<double>& elements;
  State<double> state;

  explicit Loaded(const LoadCurve& of_pressure = {})
      : scene(make(mesh, of_pressure)),
        model(scene, {"tl-perturbation"}),
        elements(*std::get<0>(model.internal_force())),
        state(elements.undeformed()) {
    RandomGeometry random(8);
    for (std::size_t row = 0; row < mesh.points.size(); ++row) {
      for (std::size_t i = 0; i < 3; ++i) state.u[row][i] = 0.1 * random.uniform(-1.0, 1.0);
    }
  }

  static Scene make(const Mesh& mesh, const LoadCurve& of_pressure) {
    Case description = plain_case(NeoHookean{});
    const NodeSets sets{{"all", nodes_where(mesh.points, [](const Vector&) { return true; })},
                        {"left", plane(mesh.points, 0, 0.0)},
                        {"top", plane(mesh.points, 2, 1.5)}};
    description.displacements = {{"left", {}}};
    description.forces.of<DeadForce>() = {{"top", {1.0, 2.0, 3.0}, {0.1, 0.0, 0.5}}};
    description.forces.of<Gravity>() = {{{0.0, -9.81e-3, 0.0}}};
    description.forces.of<Pressure>() = {{"all", 7.0, of_pressure}};
    description.forces.of<Support>() = {{"top", 5.0, 0.0, true}, {"left", 3.0, 0.0, false}};
    return make_scene(description, mesh, sets);
  }
};

/// Loads are minus the derivative of their potential, by differences.
TEST(Loads, derive_from_their_potential) {
  Loaded body;
  Loads<double> loads(body.scene, body.elements.layout());
  loads.set(0.6, 0.6);
  Rows<double> force(body.state.u.size());
  loads.subtract(body.state, force);
  for (std::size_t row = 0; row < force.size(); row += 4) {
    for (std::size_t i = 0; i < 3; ++i) {
      double& u = body.state.u[row][i];
      const double h = 1e-4, there = u;
      u = there + h;
      const double up = loads.potential(body.state.u);
      u = there - h;
      // At most of third order in one coordinate: rounding over h remains.
      EXPECT_NEAR(force[row][i], (up - loads.potential(body.state.u)) / (2.0 * h), 1e-9);
      u = there;
    }
  }
}

/// The change of the loads is the difference of their forces on a fixed body: from zero before they are set,
/// then from the previous ones. Springs do not change. Forces are below 100 N: 1e-12 is a few roundings.
TEST(Loads, change_by_the_difference_of_their_forces) {
  const Loaded body(LoadCurve{{0.0, 1.0}, {0.5, 2.0}});
  Loads<double> loads(body.scene, body.elements.layout());
  const auto forces_at = [&](double factor) {
    Loads<double> there(body.scene, body.elements.layout());
    there.set(factor, factor);
    Rows<double> force(body.state.u.size());
    there.subtract(body.state, force);
    return force;
  };
  for (const double before : {0.0, 0.2}) {
    if (before > 0.0) loads.set(before, before);
    const Rows<double> change = loads.change_to(0.6, 0.6, body.state.u);
    const Rows<double> from = forces_at(before), to = forces_at(0.6);
    for (std::size_t row = 0; row < change.size(); ++row) {
      for (std::size_t i = 0; i < 3; ++i)
        EXPECT_NEAR(change[row][i], from[row][i] - to[row][i], 1e-12) << row;
    }
  }
}

/// In a motion under pressure, weight, springs and dashpots, each with its curve, the energies balance the
/// work to second order in the step. Springs and dashpots are stiffer than the body: the motion would be
/// unstable if the stable step ignored them.
TEST(Loads, work_balances_the_energies_of_a_motion) {
  const auto imbalance = [](double stiffness, double damping, double fraction) {
    Case description = plain_case(NeoHookean{.young_modulus = 3000.0, .poisson_ratio = 0.45});
    const Mesh mesh = box({0.1, 0.1, 0.2}, {2, 2, 4});
    NodeSets sets{{"foot", plane(mesh.points, 2, 0.0)},
                  {"head", plane(mesh.points, 2, 0.2)},
                  {"side", plane(mesh.points, 0, 0.0)}};
    description.quasi_static = false;
    description.forces.of<Support>() = {{"foot", stiffness, damping, false},
                                        {"side", 0.1 * stiffness, damping, true}};
    description.forces.of<Pressure>() = {{"side", 60.0, {{0.0, 0.03, 0.1}, {0.0, 1.0, -0.5}}},
                                         {"head", 40.0}};
    description.forces.of<Gravity>() = {{{0.0, 0.0, -2.0}, {{0.0, 0.05}, {0.0, 1.0}}}};
    description.dynamics = {.duration = 0.15, .step_fraction = fraction};
    Recorder recorder;
    integrate(Model(make_scene(description, mesh, sets), {"tl-mean-dilatation"}), recorder);
    double work = 0.0, largest = 0.0;
    for (const auto& row : recorder.rows) {
      work = std::max(work, std::abs(row.external_work));
      largest = std::max(largest, std::abs(row.external_work - total_energy(row)));
    }
    return largest / work;
  };
  const double whole = imbalance(1e5, 0.0, 0.8), half = imbalance(1e5, 0.0, 0.4);
  EXPECT_LT(whole, 0.02);
  EXPECT_LT(half, 0.35 * whole);  // a quarter, plus the effect of the ends of curves
  EXPECT_LT(imbalance(1e7, 0.0, 0.9), 0.05);
  // Dashpots act half a step late: first order.
  EXPECT_LT(imbalance(1e5, 1e3, 0.1), 0.05);
  EXPECT_LT(imbalance(1e5, 1e5, 0.9), 0.5);
}

}  // namespace
}  // namespace sandglass::verification::load_energy_test
