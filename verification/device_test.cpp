// Forces and motions that an OpenCL device computes agree with those of this processor up to rounding, and
// have the same bits in every run. Skipped where OpenCL finds no device.
#include <gtest/gtest.h>

#include "assembly/method_entry.hpp"
#include "benchmark/force_check.hpp"
#include "device/opencl.hpp"
#include "device/opencl_processor.hpp"
#include "io/case_file.hpp"
#include "solve/central_difference.hpp"
#include "solve/stable_step.hpp"
#include "support/random_hexahedra.hpp"
#include "support/scenes.hpp"

namespace sandglass::verification {
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

/// A thousand steps, in which every step rounds displacements: at random, so that the error is that of one
/// step times the root of their number. A rounding of the volume change is one of the pressure, K / mu times
/// as large beside the shear stress; four is for the roundings of a step (float_budget_test.cpp), two for the
/// two motions that are compared.
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
      const double roundoff = 0.5 * (precision == Precision::double_precision
                                         ? std::numeric_limits<double>::epsilon()
                                         : static_cast<double>(std::numeric_limits<float>::epsilon()));
      const double largest = largest_distance(own.u, NodalField(own.u.size()));
      const double ratio =
          lame_lambdas(scene.materials).front() / shear_moduli(scene.materials).front() + 1.0;
      EXPECT_LE(largest_distance(other.u, own.u) / largest, 2.0 * 4.0 * roundoff * ratio * std::sqrt(steps))
          << name << ' ' << name_of(precision);
      EXPECT_EQ(integrate(Model(scene, choice), silent).u, other.u) << name << ": other bits in another run";
    }
  }
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
}  // namespace sandglass::verification
