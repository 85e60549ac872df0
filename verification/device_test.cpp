// Forces and motions that an OpenCL device computes agree with those of this processor up to rounding, and
// have the same bits in every run. Skipped where OpenCL finds no device.
#include <gtest/gtest.h>

#include "assembly/method_entry.hpp"
#include "assembly/processor.hpp"
#include "benchmark/force_check.hpp"
#include "device/opencl.hpp"
#include "device/opencl_force.hpp"
#include "device/opencl_processor.hpp"
#include "io/case_file.hpp"
#include "solve/central_difference.hpp"
#include "solve/resident.hpp"
#include "solve/stable_step.hpp"
#include "support/motion_rounding.hpp"
#include "support/obstacles.hpp"
#include "support/random_hexahedra.hpp"
#include "support/random_scene.hpp"
#include "support/scenes.hpp"

namespace sandglass::verification::device_test {
namespace {

class Device : public ::testing::Test {
 protected:
  void SetUp() override {
    if (opencl_devices().empty()) GTEST_SKIP() << "no OpenCL device: ci/setup test installs pocl-opencl-icd";
    processor_ = processor_named("opencl");
  }

  NodalField forces(const Mesh& mesh, const Materials& materials, const MethodChoice& choice,
                    const NodalField& u) const {
    return std::visit(
        [&](const auto& elements) {
          auto state = state_at(*elements, u);
          auto force = state.u;
          elements->evaluate(state, force);
          return to_field(force, elements->layout());
        },
        make_internal_force(mesh, materials, choice));
  }

  std::shared_ptr<const Processor> processor_;
};

/// A box of 60 parallelepipeds, which every method accepts: not a multiple of a work group.
Mesh sheared_box() {
  Mesh mesh = box({0.05, 0.04, 0.03}, {5, 4, 3});
  for (Vector& X : mesh.points) X = {X[0] + 0.2 * X[1], X[1] - 0.1 * X[2], X[2] + 0.15 * X[0]};
  return mesh;
}

/// Random displacements of up to a twentieth of an element.
NodalField random_displacements(const Mesh& mesh) {
  RandomGeometry random(3);
  NodalField u(mesh.points.size());
  for (Vector& row : u) {
    for (double& component : row) component = random.uniform(-5e-4, 5e-4);
  }
  return u;
}

/// Every method with one law, and every law with the methods of one point and of eight: written_test.cpp
/// compares all pairs, and a device takes a second for each kernel.
TEST_F(Device, forces_of_every_method_and_law_are_those_of_this_processor) {
  const Mesh mesh = sheared_box();
  const NodalField u = random_displacements(mesh);
  int compared = 0;
  for_each_type(ElasticLaws{}, [&]<class Law>() {
    Materials materials{{{sample_law<Law>(0.45), 1000.0}, {sample_law<NeoHookean>(0.3), 800.0}}};
    for (std::size_t e = 0; e < mesh.cells.size(); ++e)
      materials.of_element.push_back(static_cast<std::uint16_t>(e % 3 == 0));
    if (!is_isotropic<Law>) materials.axes.assign(mesh.cells.size(), RandomGeometry(1).rotation());
    for (const auto& method : method_names()) {
      const bool with_every_law = method == "tl-perturbation" || method == "tl-mean-dilatation";
      if (!with_every_law && !std::is_same_v<Law, NeoHookean>) continue;
      for (const Precision precision : {Precision::double_precision, Precision::single_precision}) {
        MethodChoice choice{.method = method, .precision = precision, .processor = processor_};
        if (!processor_->refusal(materials, choice).empty()) {
          EXPECT_THROW(make_internal_force(mesh, materials, choice), InputError) << method;
          continue;
        }
        const NodalField found = forces(mesh, materials, choice, u);
        EXPECT_EQ(forces(mesh, materials, choice, u), found) << method << ": other bits in another run";
        choice.processor = nullptr;
        EXPECT_LE(relative_difference(found, forces(mesh, materials, choice, u)),
                  force_limit(precision, materials.list.front().law))
            << method << ' ' << Law::name << ' ' << name_of(precision);
        ++compared;
      }
    }
  });
  EXPECT_GE(compared, (13 + 2 * 7) * 2);
}

/// Of each law one kernel is compiled, for all parameters.
TEST_F(Device, laws_with_other_parameters_share_a_kernel) {
  const Mesh mesh = sheared_box();
  const NodalField u = random_displacements(mesh);
  Materials materials;
  for (std::size_t e = 0; e < mesh.cells.size(); ++e) {
    const double modulus = 1000.0 + 10.0 * static_cast<double>(e);
    if (e % 2 == 0) {
      materials.list.push_back({NeoHookean{.young_modulus = modulus, .poisson_ratio = 0.3}, 1000.0});
    } else {
      materials.list.push_back({Yeoh{.c1 = modulus, .c2 = 0.1 * modulus, .c3 = 10.0, .bulk = 2e4}, 1000.0});
    }
    materials.of_element.push_back(static_cast<std::uint16_t>(e));
  }
  for (const Precision precision : {Precision::double_precision, Precision::single_precision}) {
    MethodChoice choice{.method = "tl-perturbation", .precision = precision, .processor = processor_};
    const int kernels = std::visit(
        []<class Real>(const std::unique_ptr<InternalForce<Real>>& elements) {
          return dynamic_cast<const OpenClForce<Real>&>(*elements).traffic().launches;
        },
        make_internal_force(mesh, materials, choice));
    EXPECT_EQ(kernels, 2);
    const NodalField found = forces(mesh, materials, choice, u);
    choice.processor = nullptr;
    EXPECT_LE(relative_difference(found, forces(mesh, materials, choice, u)),
              force_limit(precision, materials.list.front().law))
        << name_of(precision);
  }
}

TEST_F(Device, motions_of_cases_are_those_of_this_processor) {
  constexpr int steps = 1000;
  for (const char* name : {"column", "cylinder-compression", "pushed-ellipsoid", "stiff-core"}) {
    CaseOnMesh problem = with_mesh(
        read_case_file(std::filesystem::path(SANDGLASS_SOURCE) / "cases" / (std::string(name) + ".toml")));
    problem.description.quasi_static = false;
    const Scene probe = make_scene(problem);
    DynamicsSettings& dynamics = problem.description.dynamics;
    dynamics = {};
    dynamics.time_step =
        0.5 * stable_step(Model(probe, {"tl-perturbation"}), NodalField(probe.mesh.points.size())).step;
    dynamics.duration = steps * dynamics.time_step;
    const Scene scene = make_scene(problem);
    for (const Precision precision : {Precision::double_precision, Precision::single_precision}) {
      Observer silent;
      MethodChoice choice{.method = "tl-perturbation", .precision = precision};
      const Motion own = integrate(Model(scene, choice), silent);
      choice.processor = processor_;
      const Motion other = integrate(Model(scene, choice), silent);
      ASSERT_EQ(other.steps, own.steps);
      EXPECT_GE(other.steps, steps);
      EXPECT_GT(other.traffic.launches, 0) << name << ": the state did not stay on the device";
      const double largest = largest_distance(own.u, NodalField(own.u.size()));
      EXPECT_LE(largest_distance(other.u, own.u) / largest, rounding_of_motions(scene, precision, steps))
          << name << ' ' << name_of(precision);
      EXPECT_EQ(integrate(Model(scene, choice), silent).u, other.u) << name << ": other bits in another run";
    }
  }
}

/// A block of two materials: its head moves and turns, its foot rests on springs and dashpots, one that
/// resists only along the normal; a pressure follows one side and rises and falls, forces pull at edges, and
/// it has weight and initial velocities.
CaseOnMesh loaded_block() {
  CaseOnMesh block{plain_case(NeoHookean{.young_modulus = 3000.0, .poisson_ratio = 0.45}),
                   box({0.04, 0.03, 0.06}, {4, 3, 6})};
  const NodalField& points = block.mesh.points;
  block.sets = {{"foot", plane(points, 2, 0.0)},
                {"head", plane(points, 2, 0.06)},
                {"side", plane(points, 0, 0.04)},
                {"back", plane(points, 1, 0.03)}};
  for (int e = 0; e < 36; ++e) block.element_sets["lower"].push_back(e);
  Case& description = block.description;
  description.materials.push_back(
      {{Yeoh{.c1 = 500.0, .c2 = 100.0, .c3 = 10.0, .bulk = 2e4}, 1200.0}, "lower"});
  description.rotations = {
      {.set = "head", .axis = {0.0, 0.0, 1.0}, .angle = 0.3, .displacement = {0, 0, -0.004}}};
  description.forces.of<Pressure>() = {
      {"side", 200.0, {.times = {0.0, 0.01, 0.05}, .factors = {0.0, 1.0, 0.2}}}};
  description.forces.of<Support>() = {{"foot", 2e6, 300.0, false}, {"back", 1e5, 50.0, true}};
  description.forces.of<DeadForce>() = {{"side", {0.0, 0.02, 0.0}, {}}};
  description.forces.of<Gravity>() = {{{0.0, 0.0, -9.81}}};
  description.velocities = {{.value = {0.02, 0.0, 0.0}}};
  description.quasi_static = false;
  description.dynamics.duration = 0.06;
  description.dynamics.ramp_time = 0.04;
  description.dynamics.damping = 2.0;
  description.dynamics.frames = 7;
  return block;
}

/// Everything that a run reports, with every kind of load that the device computes: works, reactions and
/// energies are sums of products of forces and displacements, whose errors are those of the stiffest element,
/// some ten times the relative error of displacements.
TEST_F(Device, every_load_acts_on_a_state_that_stays_there) {
  const CaseOnMesh block = loaded_block();
  const Scene scene = make_scene(block);
  for (const Precision precision : {Precision::double_precision, Precision::single_precision}) {
    Recorder own, other, again;
    MethodChoice choice{.method = "tl-enhanced", .precision = precision};
    const Motion here = integrate(Model(scene, choice), own);
    choice.processor = processor_;
    const Motion there = integrate(Model(scene, choice), other);
    EXPECT_EQ(here.traffic.launches, 0);
    EXPECT_EQ(there.traffic.launches, 2 + 1 + 4 + 1) << "laws, pressures, springs and dashpots, nodes";
    ASSERT_EQ(there.steps, here.steps);
    ASSERT_EQ(other.rows.size(), own.rows.size());
    ASSERT_EQ(other.frames.size(), own.frames.size());
    const double bound = rounding_of_motions(scene, precision, static_cast<double>(here.steps));
    const double unit = largest_distance(here.u, NodalField(here.u.size()));
    double energy = 0.0, force = 0.0, speed = 0.0;
    for (const HistoryRow& row : own.rows) {
      energy = std::max({energy, row.strain, std::abs(row.external_work)});
      for (const auto& [set, reaction] : row.reactions) force = std::max(force, length(reaction));
    }
    for (const Vector& v : here.v) speed = std::max(speed, length(v));
    for (std::size_t n = 0; n < own.rows.size(); ++n) {
      const HistoryRow &a = own.rows[n], &b = other.rows[n];
      EXPECT_NEAR(b.external_work, a.external_work, 10.0 * bound * energy) << name_of(precision) << ' ' << n;
      EXPECT_NEAR(b.strain, a.strain, 10.0 * bound * energy);
      EXPECT_NEAR(b.kinetic, a.kinetic, 10.0 * bound * energy);
      EXPECT_NEAR(b.residual, a.residual, 10.0 * bound);
      for (const auto& [set, reaction] : a.reactions)
        EXPECT_LE(distance(b.reactions.at(set), reaction), 10.0 * bound * force) << set;
    }
    for (std::size_t n = 0; n < own.frames.size(); ++n)
      EXPECT_LE(largest_distance(other.frames[n].u, own.frames[n].u), bound * unit) << n;
    EXPECT_LE(largest_distance(there.v, here.v), 10.0 * bound * speed);
    integrate(Model(scene, choice), again);
    ASSERT_EQ(again.rows.size(), other.rows.size());
    for (std::size_t n = 0; n < again.rows.size(); ++n)
      EXPECT_EQ(again.rows[n].external_work, other.rows[n].external_work) << "other bits in another run";
  }
}

/// Steps that prove too long are taken again from the last check,
/// whether they are taken here or there.
TEST_F(Device, a_state_returns_to_the_last_check) {
  const Scene scene = scene_with_too_long_steps();
  Recorder recorder;
  MethodChoice choice{.method = "tl-mean-dilatation"};
  choice.processor = processor_;
  const Motion motion = integrate(Model(scene, choice), recorder);
  EXPECT_GT(motion.traffic.launches, 0);
  EXPECT_GT(motion.repeated, 0);
  double largest = 0.0;
  for (const HistoryRow& row : recorder.rows) {
    largest = std::max(largest, row.external_work);
    EXPECT_LT(total_energy(row) - row.external_work, 0.01 * largest + 1e-12);
  }
}

/// A body without constraints and loads flies on: u = v t, up to the rounding of a sum of some hundred steps.
TEST_F(Device, a_free_body_flies_on) {
  CaseOnMesh block = loaded_block();
  Case& description = block.description;
  description.rotations.clear();
  description.forces = {};
  description.dynamics.damping = 0.0;
  description.dynamics.frames = 1;
  const Scene scene = make_scene(block);
  MethodChoice choice{.method = "tl-enhanced"};
  choice.processor = processor_;
  Observer silent;
  const Motion motion = integrate(Model(scene, choice), silent);
  EXPECT_GT(motion.traffic.launches, 0);
  EXPECT_LE(largest_distance(motion.u, NodalField(motion.u.size(), {0.02 * motion.time, 0.0, 0.0})),
            1e-12 * 0.02 * motion.time);
}

/// The head passes through the element below it in one step: found on the device, and said as it is here.
TEST_F(Device, inverted_elements_are_found_there) {
  CaseOnMesh block = loaded_block();
  block.description.rotations.front().displacement = {0.0, 0.0, -0.03};
  DynamicsSettings& dynamics = block.description.dynamics;
  dynamics.time_step = dynamics.ramp_time = 1e-4;
  dynamics.check_interval = 1;
  const Scene scene = make_scene(block);
  std::vector<std::string> said;
  for (const auto& processor : {std::shared_ptr<const Processor>{}, processor_}) {
    MethodChoice choice{.method = "tl-mean-dilatation"};
    choice.processor = processor;
    Observer silent;
    try {
      integrate(Model(scene, choice), silent);
    } catch (const ComputationError& error) {
      said.emplace_back(error.what());
    }
  }
  ASSERT_EQ(said.size(), 2);
  EXPECT_NE(said[0].find("det F must be positive"), std::string::npos) << said[0];
  EXPECT_EQ(said[0], said[1]);
}

/// Such a body moves all the same: its state is copied in every step.
TEST_F(Device, what_cannot_stay_there_is_named) {
  CaseOnMesh block = loaded_block();
  const Scene scene = make_scene(block);
  EXPECT_EQ(why_not_resident(scene), "");
  Scene other = scene;
  other.settings.dynamics.subcycles = 2;
  EXPECT_NE(why_not_resident(other).find("subcycles"), std::string::npos);
  other = scene;
  other.ties.push_back({0, {{1, 1.0}}});
  EXPECT_NE(why_not_resident(other).find("ties"), std::string::npos);

  block.description.forces.of<Support>().clear();
  block.description.forces.of<Obstacle>() = {ground()};
  const Scene on_ground = make_scene(block);
  EXPECT_NE(why_not_resident(on_ground).find("[[obstacle]]"), std::string::npos);
  Observer silent;
  MethodChoice choice{.method = "tl-enhanced"};
  const Motion here = integrate(Model(on_ground, choice), silent);
  choice.processor = processor_;
  const Motion there = integrate(Model(on_ground, choice), silent);
  EXPECT_EQ(there.traffic.launches, 0);
  EXPECT_LE(largest_distance(there.u, here.u),
            rounding_of_motions(on_ground, Precision::double_precision, static_cast<double>(here.steps)) *
                largest_distance(here.u, NodalField(here.u.size())));
}

TEST_F(Device, names_that_are_no_processor_are_refused_with_those_that_are) {
  EXPECT_EQ(processor_named("cpu"), nullptr);
  for (const char* name : {"cuda", "opencl:0", "opencl:99", "opencl:", "opencl:1x", ""}) {
    try {
      processor_named(name);
      FAIL() << name;
    } catch (const InputError& error) {
      EXPECT_NE(std::string(error.what()).find("cpu, opencl:1 ("), std::string::npos) << error.what();
    }
  }
}

}  // namespace
}  // namespace sandglass::verification::device_test
