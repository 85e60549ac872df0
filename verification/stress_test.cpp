/// Stresses of elements and reactions of sets, against closed forms, nodal forces and imposed loads.

#include <gtest/gtest.h>

#include <cmath>

#include "assembly/face_gather.hpp"
#include "assembly/method_entry.hpp"
#include "mesh/hexahedron.hpp"
#include "solve/central_difference.hpp"
#include "solve/frame.hpp"
#include "solve/relaxation.hpp"
#include "support/method_test.hpp"
#include "support/patch_mesh.hpp"
#include "support/plates.hpp"
#include "support/random_hexahedra.hpp"

namespace sandglass::verification::stress_test {
namespace {

/// The stress (Pa) of one element in a frame.
Tensor<double> stress_of(const Frame& frame, std::size_t element) {
  Tensor<double> sigma;
  for (std::size_t n = 0; n < 9; ++n) sigma.entries[n] = frame.stresses[9 * element + n];
  return sigma;
}

double largest_entry(const Tensor<double>& tensor) {
  double largest = 0.0;
  for (const double entry : tensor.entries) largest = std::max(largest, std::abs(entry));
  return largest;
}

/// sum_I f_I (x) x_I of internal forces f (N) at x = X + u (m), in small-strain theory at X: the integral of
/// the stress over the body (J), by the virial theorem.
Tensor<double> virial(const NodalField& force, const NodalField& X, const NodalField& u, bool small_strain) {
  Tensor<double> sum{};
  for (std::size_t n = 0; n < X.size(); ++n) {
    for (int i = 0; i < 3; ++i) {
      for (int j = 0; j < 3; ++j) {
        const double x = X[n][index(j)] + (small_strain ? 0.0 : u[n][index(j)]);
        sum(i, j) += force[n][index(i)] * x;
      }
    }
  }
  return sum;
}

class StressTest : public MethodTest {
 protected:
  /// A patch deformed by H, whose inner nodes also move at random, by a share `waviness` of their distances.
  static std::pair<Scene, NodalField> strained(const AnyLaw& law, double waviness) {
    const Tensor<double> H{{0.1, 0.05, -0.02, 0.04, -0.06, 0.03, 0.01, -0.07, 0.12}};
    const Mesh mesh = fitting_patch(GetParam());
    NodalField u;
    RandomGeometry random(5);
    for (const Vector& X : mesh.points) {
      u.push_back(linear(H, X));
      for (double& component : u.back()) component += waviness * random.uniform(-1.0, 1.0);
    }
    return {patch_scene(law, H, mesh), u};
  }
};

INSTANTIATE_TEST_SUITE_P(, StressTest, each_of(Methods{}), method_label);

/// Stresses of elements, times their volumes, sum to the virial of their forces for any motion, which would
/// fail with the stress of one point instead of the mean, or with other volumes. Hourglass forces are no
/// stress of the material: kappa is zero here, and controls that have energy nevertheless are left to the
/// test of uniform motion.
TEST_P(StressTest, of_the_elements_sum_up_to_the_virial_of_the_nodal_forces) {
  const auto [scene, u] = strained(sample_law<NeoHookean>(0.45), 0.02);
  MethodChoice plain = choice();
  if (method.takes_kappa) plain.kappa = 0.0;
  const Model model(scene, plain);
  const Frame frame = static_frame(model, 1.0, u);
  if (strain_energies(model, u).hourglass > 0.0) return;
  Tensor<double> sum{};
  for (std::size_t e = 0; e < scene.mesh.cells.size(); ++e) {
    // The volume used by the element: of its nodes if updated, else J times the undeformed one.
    NodalVectors<double> x = gather(scene.mesh.points, scene.mesh.cells[e]);
    double volume = mean_gradient(x).volume;
    if (is_updated_lagrangian(method)) {
      x += gather(u, scene.mesh.cells[e]);
      volume = mean_gradient(x).volume;
    } else if (!method.is_linear) {
      volume *= frame.jacobians[e];
    }
    sum += volume * stress_of(frame, e);
  }
  const auto expected = virial(internal_forces(model, u), scene.mesh.points, u, method.is_linear);
  EXPECT_LT(largest_entry(sum - expected), 1e-12 * largest_entry(expected));
}

/// The material's stress does not depend on the strength of the hourglass control.
TEST_P(StressTest, excludes_the_hourglass_control) {
  if (!method.takes_kappa) return;
  const auto [scene, u] = strained(sample_law<NeoHookean>(0.45), 0.02);
  const auto stresses = [&](double kappa) {
    return static_frame(Model(scene, {.method = GetParam(), .kappa = kappa}), 1.0, u).stresses;
  };
  EXPECT_EQ(stresses(0.0), stresses(1.0));
}

/// In a uniform motion the stress is the law's, in float and double, with any control, and symmetric: sigma =
/// mu J^(-5/3) dev(F F^T) + K (J - 1) for the neo-Hookean law, 2 mu dev(e) + K tr(e) for small strains.
TEST_P(StressTest, of_a_uniform_motion_is_the_closed_form) {
  const auto law = sample_law<NeoHookean>(0.45);
  const auto [scene, u] = strained(law, 0.0);
  const Tensor<double> H{{0.1, 0.05, -0.02, 0.04, -0.06, 0.03, 0.01, -0.07, 0.12}};
  const Tensor<double> F = identity<double>() + H;
  const double J = determinant(F), mu = law.shear_modulus(), K = law.bulk_modulus();
  const Tensor<double> e = 0.5 * (H + transpose(H));
  const Tensor<double> expected =
      method.is_linear
          ? 2.0 * mu * deviator(e) + K * trace(e) * identity<double>()
          : mu * std::pow(J, -5.0 / 3.0) * deviator(F * transpose(F)) + K * (J - 1.0) * identity<double>();
  // Roundoff of the strain times the ratio of bulk modulus and stress, about ten.
  for (const auto& [precision, tolerance] :
       {std::pair{Precision::double_precision, 1e-13}, {Precision::single_precision, 3e-5}}) {
    const Model model(scene, choice(precision));
    const Frame frame = static_frame(model, 1.0, u);
    ASSERT_EQ(frame.stresses.size(), 9 * scene.mesh.cells.size());
    for (std::size_t n = 0; n < scene.mesh.cells.size(); ++n) {
      EXPECT_LT(largest_entry(stress_of(frame, n) - expected), tolerance * K) << n;
    }
  }
}

/// Evaluating stresses does not change the memory of a law: after a step, the stress balances the step's
/// forces, and a second evaluation gives the same bits.
TEST_P(StressTest, of_a_law_that_remembers_is_that_of_the_last_step) {
  if (method.knows_viscoelasticity) {
    const auto [scene, u] = strained(sample_law<Viscoelastic<NeoHookean>>(0.45), 0.0);
    const Model model(scene, choice());
    const auto& elements = *std::get<std::unique_ptr<InternalForce<double>>>(model.internal_force());
    State<double> state = state_at(elements, u);
    state.step = 0.3;  // s, in which a part of the stress relaxes
    Rows<double> force(state.u.size());
    elements.evaluate(state, force);
    const auto coordinates = centred_coordinates<double>(scene.mesh.points, elements.layout());
    std::vector<double> stresses(9 * scene.mesh.cells.size()), again(stresses);
    elements.stresses(state, coordinates, stresses);
    elements.stresses(state, coordinates, again);
    EXPECT_EQ(stresses, again);
    const auto expected = virial(to_field(force, elements.layout()), scene.mesh.points, u, false);
    const double volume = determinant(
        identity<double>() + Tensor<double>{{0.1, 0.05, -0.02, 0.04, -0.06, 0.03, 0.01, -0.07, 0.12}});
    for (std::size_t n = 0; n < 9; ++n) {
      EXPECT_NEAR(volume * stresses[n], expected.entries[n], 1e-12 * largest_entry(expected)) << n;
    }
  }
}

/// A block is stretched between frictionless planes: there is one stress along it, none across, and the
/// reaction is that stress times the area of the stretched block.
TEST(Reactions, of_a_uniaxial_stretch_are_stress_times_area) {
  const auto law = sample_law<NeoHookean>(0.45);
  Case description = plain_case(law);
  const Mesh mesh = box({0.1, 0.2, 0.3}, {2, 2, 3});
  const auto where = [&](std::size_t axis, double x) {
    return nodes_where(mesh.points, [=](const Vector& X) { return std::abs(X[axis] - x) < 1e-9; });
  };
  const NodeSets sets{
      {"left", where(0, 0.0)}, {"front", where(1, 0.0)}, {"foot", where(2, 0.0)}, {"head", where(2, 0.3)}};
  description.displacements = {{"left", {}, {true, false, false}},
                               {"front", {}, {false, true, false}},
                               {"foot", {}, {false, false, true}},
                               {"head", {0.0, 0.0, 0.09}, {false, false, true}}};
  description.relaxation.tolerance = 1e-12;
  const Scene scene = make_scene(description, mesh, sets);
  for (const char* method : {"tl-perturbation", "tl-mean-dilatation", "tl-four-point", "t4", "t4-anp"}) {
    SCOPED_TRACE(method);
    Recorder recorder;
    ASSERT_TRUE(relax(Model(scene, {.method = method}), recorder).converged);
    const Frame& frame = recorder.frames.back();
    const double J = frame.jacobians.front(), along = 1.3;
    const double pull = law.shear_modulus() * std::pow(J, -5.0 / 3.0) * (along * along - J / along);
    const double largest = 1e-9 * law.bulk_modulus();  // 1e-12 of the reactions, over the shear modulus
    for (std::size_t e = 0; e < mesh.cells.size(); ++e) {
      const Tensor<double> expected{{0, 0, 0, 0, 0, 0, 0, 0, pull}};
      EXPECT_LT(largest_entry(stress_of(frame, e) - expected), largest) << e;
    }
    const double area = 0.1 * 0.2 * J / along;
    ASSERT_EQ(frame.reactions.size(), 4U);
    EXPECT_NEAR(frame.reactions.at("head")[2], pull * area, largest * area);
    EXPECT_NEAR(frame.reactions.at("foot")[2], -pull * area, largest * area);
    EXPECT_NEAR(frame.reactions.at("left")[0], 0.0, largest * area);
    EXPECT_EQ(frame.reactions.at("left")[2], 0.0);  // foot and head hold its nodes along the block
    EXPECT_EQ(recorder.rows.back().reactions, frame.reactions);
    EXPECT_EQ(recorder.rows.front().reactions.at("head"), Vector{});
  }
}

/// In static equilibrium reactions balance the loads: they sum to minus the loads, of nodes and of pressures.
TEST(Reactions, sum_to_minus_the_loads) {
  Case description = plain_case(sample_law<NeoHookean>(0.45));
  description.forces.of<DeadForce>() = {{.set = "side", .total = {0.02, 0.3, 0.1}}};
  description.relaxation.tolerance = 1e-10;
  const Scene scene = make_scene(block_between_plates(description, true, {2, 2, 8}));
  for (const char* method : {"tl-perturbation", "tl-adaptive", "t4-anp", "linear-condensed"}) {
    Recorder recorder;
    relax(Model(scene, {.method = method}), recorder);
    const Reactions& reactions = recorder.frames.back().reactions;
    ASSERT_EQ(reactions.size(), 2U) << method;
    const Vector foot = reactions.at("foot"), head = reactions.at("head");
    const Vector load{0.02, 0.3, 0.1};
    for (std::size_t i = 0; i < 3; ++i) EXPECT_NEAR(foot[i] + head[i], -load[i], 1e-8) << method;
  }
}

/// In motion, reactions and loads together accelerate the free nodes: the rows of every frame have the forces
/// at its time.
TEST(Reactions, of_a_motion_are_those_of_its_frames) {
  const Scene scene =
      make_scene(block_between_plates(plain_case(sample_law<NeoHookean>(0.45)), false, {2, 2, 8}));
  const Model model(scene, {.method = "tl-perturbation"});
  Recorder recorder;
  integrate(model, recorder);
  const Frame& last = recorder.frames.back();
  EXPECT_EQ(recorder.rows.back().reactions, last.reactions);
  const NodalField force = internal_forces(model, last.u);
  Vector head{};
  for (const int node : scene.sets.at("head")) {
    for (std::size_t i = 0; i < 3; ++i) head[i] += force[index(node)][i];
  }
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_NEAR(last.reactions.at("head")[i], head[i], 1e-10 * length(head));
  }
}

}  // namespace
}  // namespace sandglass::verification::stress_test
