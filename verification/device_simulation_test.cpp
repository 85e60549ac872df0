// Simulations whose steps an OpenCL device takes move as those of this processor, up to rounding, whatever a
// program does between the steps. Skipped where OpenCL finds no device.
#include <gtest/gtest.h>

#include <thread>

#include "device/opencl.hpp"
#include "io/case_file.hpp"
#include "mesh/vectors.hpp"
#include "sandglass/batch.hpp"
#include "sandglass/driven_problem.hpp"
#include "support/field_of.hpp"
#include "support/motion_rounding.hpp"
#include "support/scenes.hpp"
#include "support/temporary_folder.hpp"

namespace sandglass::verification::device_simulation_test {
namespace {

class DeviceSimulation : public ::testing::Test {
 protected:
  void SetUp() override {
    if (opencl_devices().empty()) GTEST_SKIP() << "no OpenCL device: ci/setup test installs pocl-opencl-icd";
  }
};

/// A block with weight and a pressure on one side; its foot is held, and `head` turns when the case imposes
/// it.
std::string text_with(const std::string& more = "") {
  return R"([case]
name = "block"
requirement = "A block is moved."
answer = "dynamic"
[material]
law = "neo-hookean"
young_modulus = 3000.0
poisson_ratio = 0.45
density = 1000.0
[sets]
foot = { z = [0.0, 0.0] }
head = { z = [0.2, 0.2] }
side = { x = [0.1, 0.1] }
[[displacement]]
set = "foot"
value = [0.0, 0.0, 0.0]
[[rotation]]
set = "head"
axis = "z"
angle = 20.0
displacement = [0.0, 0.0, 0.01]
[[pressure]]
set = "side"
value = 50.0
[dynamics]
duration = 1.0
damping = 3.0
)" + more;
}

MeshArrays block() {
  const Mesh mesh = box({0.1, 0.1, 0.2}, {2, 2, 4});
  return {mesh.points, mesh.cells};
}

template <class Real>
Simulation<Real> made(const std::string& device, const std::string& text = text_with()) {
  return {block(), text, {.method = "tl-enhanced", .device = device}};
}

/// What a program does: pulls, presses with the case's loads, holds still, and reverses, in frames of one
/// step and of many, with and without a check within.
template <class Real>
void drive(Simulation<Real>& simulation, const auto& after_frame) {
  simulation.impose(0.5);
  simulation.advance(0.101);
  after_frame();
  simulation.move("head", {0.004, -0.003, 0.01});
  simulation.advance(0.503);
  after_frame();
  simulation.advance(0.4 * simulation.step_size());
  after_frame();
  const std::vector<Vector> each(simulation.nodes("head").size(), {0.0, 0.002, -0.003});
  simulation.move("head", each);
  simulation.advance(0.307);
  after_frame();
}

template <class Real>
std::vector<NodalField> frames_of(Simulation<Real>& simulation) {
  std::vector<NodalField> frames;
  drive(simulation, [&] { frames.push_back(field_of(simulation)); });
  return frames;
}

/// Reactions are products of stiffness and displacement, with some ten times the relative error.
template <class Real>
void expect_same_motion() {
  auto here = made<Real>("cpu"), there = made<Real>("opencl");
  std::vector<NodalField> expected;
  std::vector<Vector> reactions;
  drive(here, [&] {
    expected.push_back(field_of(here));
    reactions.push_back(here.reaction("head"));
  });
  const double bound =
      rounding_of_motions(read_scene(text_with(), checked(block())), precision_of<Real>, 200.0);
  std::size_t frame = 0;
  const NodalView<Real> view = there.displacements();
  drive(there, [&] {
    const double largest = largest_distance(expected[frame], NodalField(expected[frame].size()));
    EXPECT_GT(largest, 1e-3);
    EXPECT_LE(largest_distance(field_of(there), expected[frame]), bound * largest) << frame;
    EXPECT_LE(distance(there.reaction("head"), reactions[frame]), 10.0 * bound * length(reactions[frame]));
    EXPECT_EQ(there.displacements().data, view.data) << "views stay valid";
    ++frame;
  });
  EXPECT_EQ(frame, 4);
  EXPECT_NEAR(there.time(), here.time(), 1e-14);
}

TEST_F(DeviceSimulation, moves_as_here_in_double) {
  expect_same_motion<double>();
}
TEST_F(DeviceSimulation, moves_as_here_in_float) {
  expect_same_motion<float>();
}

/// Each copy has its own state on the device; threads that step them at the same time share the elements, and
/// each goes its own way.
TEST_F(DeviceSimulation, copies_move_independently_with_the_same_bits) {
  auto first = made<float>("opencl");
  first.impose(1.0);
  first.advance(0.2);
  std::vector<Simulation<float>> one_by_one(3, first);
  one_by_one.push_back(std::move(first));  // its state is on the device already
  std::vector<Simulation<float>> together = one_by_one;
  const auto swing = [](Simulation<float>& simulation, std::size_t n) {
    for (int frame = 0; frame < 100; ++frame) {
      simulation.move("head", {0.002 * static_cast<double>(n), 0.0, frame % 2 == 0 ? 0.003 : -0.003});
      simulation.advance(0.05);
    }
  };
  std::vector<std::thread> threads;
  for (std::size_t n = 0; n < together.size(); ++n) threads.emplace_back([&, n] { swing(together[n], n); });
  for (std::thread& thread : threads) thread.join();
  for (std::size_t n = 0; n < together.size(); ++n) {
    swing(one_by_one[n], n);
    EXPECT_EQ(field_of(together[n]), field_of(one_by_one[n])) << n;
  }
}

TEST_F(DeviceSimulation, continues_from_a_file_with_the_same_bits) {
  TemporaryFolder folder;
  auto simulation = made<double>("opencl"), other = made<double>("opencl");
  simulation.impose(1.0);
  simulation.advance(0.13);
  simulation.save(folder / "state");
  other.advance(0.1);  // its state there must not be used
  other.resume(folder / "state");
  EXPECT_EQ(frames_of(other), frames_of(simulation));
}

/// Nothing moves in equilibrium, but for 1e-8 of the reactions by which forces do not balance: velocities and
/// displacements there are replaced.
TEST_F(DeviceSimulation, rests_after_settling) {
  auto simulation = made<double>("opencl");
  simulation.impose(1.0);
  simulation.advance(0.2);
  simulation.settle();
  const NodalField settled = field_of(simulation);
  simulation.advance(0.5);
  EXPECT_LT(largest_distance(field_of(simulation), settled), 1e-7 * 0.03);
}

/// The head is pushed far through the body in one frame, upside down with steps of any length: as here, the
/// simulation is back at its last sound state and may move elsewhere.
TEST_F(DeviceSimulation, returns_to_its_last_sound_state) {
  auto here = made<double>("cpu"), there = made<double>("opencl");
  std::vector<std::string> said;
  for (Simulation<double>* one : {&here, &there}) {
    one->move("head", {0.0, 0.0, -5.0});
    try {
      one->advance(0.3);
    } catch (const ComputationError& error) {
      said.emplace_back(error.what());
    }
    one->impose(0.0);
    one->advance(0.2);
  }
  ASSERT_EQ(said.size(), 2);
  EXPECT_EQ(said[0], said[1]);
  const double bound =
      rounding_of_motions(read_scene(text_with(), checked(block())), Precision::double_precision, 200.0);
  EXPECT_LE(largest_distance(field_of(there), field_of(here)), bound * 0.03);
}

/// The head is pressed so fast that elements turn inside out before a check, but not with shorter steps, as
/// in simulation_failure_test.cpp. Such a motion amplifies rounding; another path, or steps from an unsound
/// state, would change the first digits.
TEST_F(DeviceSimulation, takes_steps_that_prove_too_long_again) {
  const auto pressed = [](const std::string& device) {
    Simulation<double> simulation(block(), text_with(),
                                  {.method = "tl-mean-dilatation", .step_fraction = 1.0, .device = device});
    simulation.move("head", {0.0, 0.0, -0.09});
    simulation.advance(0.05);
    simulation.advance(0.1);
    EXPECT_NEAR(simulation.time(), 0.15, 1e-12);
    return field_of(simulation);
  };
  const NodalField here = pressed("cpu"), there = pressed("opencl");
  EXPECT_LT(largest_distance(there, here), 1e-6 * 0.09);
}

TEST_F(DeviceSimulation, what_cannot_stay_there_is_refused_by_name) {
  const auto refusal = [](const std::string& device, const std::string& more, const char* method) {
    return input_error(
        [&] { Simulation<double>(block(), text_with(more), {.method = method, .device = device}); });
  };
  const auto expect = [](const std::string& said, const char* part) {
    EXPECT_NE(said.find(part), std::string::npos) << said;
  };
  const std::string floor =
      "[[obstacle]]\nname = \"floor\"\nshape = \"plane\"\npoint = [0.0, 0.0, -1.0]\nnormal = [0.0, 0.0, "
      "1.0]\n"
      "set = \"side\"\n";
  expect(refusal("opencl", floor, "tl-enhanced"), "[[obstacle]] acts on it");
  expect(refusal("opencl", "subcycles = 4\n", "tl-enhanced"), "subcycles");
  expect(refusal("opencl", "", "tl-adaptive"), "method 'tl-adaptive' runs on this processor alone");
  expect(refusal("cuda", "", "tl-enhanced"), "device = 'cuda' is no processor of this machine");
  expect(refusal("opencl:99", "", "tl-enhanced"), "allowed: cpu, opencl:1");
  expect(
      input_error([&] { Batch<double>(block(), text_with(), 2, {.method = "tl-none", .device = "opencl"}); }),
      "this processor alone");
}

}  // namespace
}  // namespace sandglass::verification::device_simulation_test
