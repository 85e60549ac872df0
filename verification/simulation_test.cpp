/// The library inside a program: the same motion as `integrate`, views, snapshots, reactions.

#include <gtest/gtest.h>

#include "io/case_file.hpp"
#include "sandglass/driven_problem.hpp"
#include "solve/central_difference.hpp"
#include "solve/relaxation.hpp"
#include "solve/steady_step.hpp"
#include "support/allocations.hpp"
#include "support/field_of.hpp"
#include "support/simulated_block.hpp"
#include "support/temporary_folder.hpp"

namespace sandglass::verification::simulation_test {
namespace {

using simulated_block::block, simulated_block::pulled, simulated_block::text_of;

constexpr double step = 1e-3;  // s; stable for the blocks below
constexpr int steps = 200;

/// The motion of a dynamic run in these steps; the text ends with the table [dynamics].
Motion motion_of(const std::string& text, const MethodChoice& choice) {
  const Scene scene = read_scene(text + "time_step = 1e-3\n", checked(block()));
  const Model model(scene, choice);
  Observer nobody;
  return integrate(model, nobody);
}

double smooth(double t) {
  return t * t * t * (10.0 + t * (6.0 * t - 15.0));
}

/// The curve is rounded elsewhere than in `integrate`: each of 200 steps displaces driven nodes by at most
/// 3.5e-18 m, half a unit in the last place of 0.03 m, and two sums over as many stable steps accumulate
/// that. Other mistakes change the first digits.
constexpr double roundoff = 200.0 * 200.0 * 3.5e-18;  // m

class MotionTest : public ::testing::TestWithParam<SimulationSettings> {};

TEST_P(MotionTest, moved_by_hand_it_matches_the_dynamic_run) {
  const SimulationSettings& settings = GetParam();
  const std::string text = text_of(pulled) + "check_interval = 5\n";  // levels change at every tenth check
  const Motion motion = motion_of(text, {.method = *settings.method, .kappa = settings.kappa, .threads = 2});
  Simulation<double> simulation(block(), text, settings);
  ASSERT_LT(step, simulation.step_size());
  for (int n = 1; n <= steps; ++n) {
    const double share = smooth(n * step / 0.2);
    simulation.move("head", {0.02 * share, 0.01 * share, 0.03 * share});
    simulation.advance(step);
  }
  EXPECT_NEAR(simulation.time(), motion.time, 1e-14);
  EXPECT_LT(largest_distance(field_of(simulation), motion.u), roundoff);
}

INSTANTIATE_TEST_SUITE_P(Methods, MotionTest,
                         ::testing::Values(SimulationSettings{.method = "tl-perturbation"},
                                           SimulationSettings{.method = "tl-perturbation", .kappa = 0.5},
                                           SimulationSettings{.method = "tl-adaptive"},
                                           SimulationSettings{.method = "ul-perturbation"}));

TEST(Simulation, follows_what_the_case_imposes_turning_sets_and_forces_too) {
  const std::string turned =
      "[[rotation]]\nset = \"head\"\naxis = \"z\"\nangle = 60.0\ndisplacement = [0.0, 0.0, 0.01]\n"
      "[sets.side]\nx = [0.1, 0.1]\n[[force]]\nset = \"side\"\ntotal = [0.05, 0.0, 0.0]\n";
  const Motion motion = motion_of(text_of(turned), {.method = "tl-perturbation"});
  Simulation<double> simulation(block(), text_of(turned));
  for (int n = 1; n <= steps; ++n) {
    simulation.impose(smooth(n * step / 0.2));
    simulation.advance(step);
  }
  EXPECT_LT(largest_distance(field_of(simulation), motion.u), roundoff);
}

TEST(Simulation, starts_with_the_initial_velocities_of_a_file) {
  const std::string thrown = text_of("[[velocity]]\nvalue = [0.0, 0.2, 0.0]\n");
  TemporaryFolder folder;
  const auto file = folder / "thrown.toml";
  std::ofstream(file) << thrown +
                             "[mesh]\ngenerator = \"box\"\nsize = [0.1, 0.1, 0.2]\nelements = [2, 2, 4]\n";
  const Motion motion = motion_of(thrown, {.method = "tl-energy-sampling"});
  Simulation<double> simulation(file, {.method = "tl-energy-sampling"});
  for (int n = 1; n <= steps; ++n) simulation.advance(step);
  EXPECT_GT(largest_distance(motion.u, NodalField(motion.u.size())), 1e-3);
  EXPECT_LT(largest_distance(field_of(simulation), motion.u), roundoff);
}

TEST(Simulation, a_frame_of_many_steps_moves_driven_nodes_straight) {
  Simulation<double> frame(block(), text_of(pulled)), by_steps(frame);
  constexpr int n = 16;  // a share of 1 / 16 has no roundoff
  const double size = frame.step_size();
  frame.move("head", {0.0, 0.0, 0.016});
  frame.advance(n * size);
  for (int k = 1; k <= n; ++k) {
    by_steps.move("head", {0.0, 0.0, 0.001 * k});
    by_steps.advance(size);
  }
  EXPECT_NEAR(frame.time(), by_steps.time(), 1e-15);
  EXPECT_LT(largest_distance(field_of(frame), field_of(by_steps)), roundoff);
  const auto head = frame.nodes("head");
  EXPECT_EQ(field_of(frame)[index(head[0])], (Vector{0.0, 0.0, 0.016}));
}

TEST(Simulation, forces_grow_straight_too) {
  const std::string pushed =
      "[sets.side]\nx = [0.1, 0.1]\n[[force]]\nset = \"side\"\ntotal = [0.05, 0.0, 0.0]\n";
  Simulation<double> frame(block(), text_of(pulled + pushed)), by_steps(frame);
  constexpr int n = 8;  // two frames end before the step is chosen again
  const double size = frame.step_size();
  for (const double before : {0.0, 0.5}) {
    frame.impose(before + 0.5);
    frame.advance(n * size);
    for (int k = 1; k <= n; ++k) {
      by_steps.impose(before + 0.5 * k / n);
      by_steps.advance(size);
    }
    EXPECT_LT(largest_distance(field_of(frame), field_of(by_steps)), roundoff);
  }
}

TEST(Simulation, steps_shorten_as_the_body_stiffens) {
  Simulation<double> simulation(block(), text_of(pulled), {.damping = 15.0});
  const double undeformed_step = simulation.step_size() / SteadyStep::first_share;
  simulation.move("head", {0.0, 0.0, -0.1});
  simulation.advance(1.0);
  // At half its height, the block is half as far from face to face, and wider.
  EXPECT_LT(simulation.step_size(), 0.7 * undeformed_step);
  EXPECT_GT(simulation.step_size(), 0.2 * undeformed_step);
}

TEST(Simulation, no_frame_is_too_long_for_a_stable_motion) {
  const Scene scene = read_scene(text_of(pulled, "quasi-static"), checked(block()));
  Observer nobody;
  const Relaxation rest = relax(Model(scene, {.method = "tl-perturbation"}), nobody);
  Simulation<double> simulation(block(), text_of(pulled, "quasi-static"), {.damping = 15.0});
  simulation.move("head", {0.02, 0.01, 0.03});
  simulation.advance(0.5);
  simulation.advance(4.0);
  // Every mode is faster than 7.5 rad/s and so decays by exp(-15 / 2 * 4) = 1e-13; the static answer is
  // accurate to its tolerance, 1e-8 of 0.03 m.
  EXPECT_LT(largest_distance(field_of(simulation), rest.u), 1e-9);
}

TEST(Simulation, each_node_of_a_set_goes_its_own_way) {
  Simulation<double> simulation(block(), text_of(pulled));
  const auto head = simulation.nodes("head");
  std::vector<Vector> own;
  for (std::size_t n = 0; n < head.size(); ++n) own.push_back({1e-4 * static_cast<double>(n), 0.0, -2e-4});
  simulation.move("head", own);
  simulation.advance(0.01);
  for (std::size_t n = 0; n < head.size(); ++n) EXPECT_EQ(field_of(simulation)[index(head[n])], own[n]);
  simulation.advance(0.01);  // no new target: they stay
  for (std::size_t n = 0; n < head.size(); ++n) EXPECT_EQ(field_of(simulation)[index(head[n])], own[n]);
}

TEST(Simulation, components_that_the_case_leaves_free_stay_free) {
  const std::string lifted =
      "[[displacement]]\nset = \"head\"\nvalue = [0.0, 0.0, 0.01]\ncomponents = \"z\"\n";
  Simulation<double> simulation(block(), text_of(lifted));
  simulation.move("head", {0.5, 0.5, 0.02});
  simulation.advance(0.1);
  for (const int n : simulation.nodes("head")) {
    const Vector u = field_of(simulation)[index(n)];
    EXPECT_EQ(u[2], 0.02);
    EXPECT_LT(std::abs(u[0]), 0.02);  // it becomes slightly thinner
  }
}

TEST(Simulation, views_show_the_present_in_one_place_and_steps_allocate_nothing) {
  Simulation<float> simulation(block(), text_of(pulled));
  const auto u = simulation.displacements();
  const auto row = index(simulation.row_of_node()[index(simulation.nodes("head")[3])]);
  EXPECT_EQ(u[row][2], 0.0F);
  simulation.move("head", {0.0, 0.0, 0.01});
  const long before = allocations();
  simulation.advance(0.1);
  EXPECT_EQ(allocations(), before);
  EXPECT_EQ(u[row][2], 0.01F);
  EXPECT_EQ(simulation.displacements().data, u.data);
  Simulation<float> moved(std::move(simulation));
  EXPECT_EQ(moved.displacements().data, u.data);
}

/// The static answer of the same loads, bit by bit, since both use the same search: a factor that is a power
/// of two is exact.
template <class Real>
void expect_settled(const char* method, const std::string& driven, double factor) {
  SCOPED_TRACE(method);
  Simulation<Real> simulation(block(), text_of(driven), {.method = method});
  const auto* before = simulation.displacements().data;
  simulation.impose(0.3 * factor);
  simulation.advance(0.05);
  simulation.impose(factor);
  EXPECT_GT(simulation.settle(), 3);
  const Scene scene = scaled(read_scene(text_of(driven), checked(block())), factor);
  Observer silent;
  const bool single = std::is_same_v<Real, float>;
  const Relaxation expected =
      relax(Model(scene, {.method = method,
                          .precision = single ? Precision::single_precision : Precision::double_precision}),
            silent);
  EXPECT_EQ(field_of(simulation), expected.u);
  EXPECT_EQ(simulation.displacements().data, before);
  EXPECT_DOUBLE_EQ(simulation.time(), 0.05);  // a sum of steps
}

TEST(Simulation, settles_where_a_static_run_ends) {
  const std::string loaded = pulled + "[[force]]\nset = \"foot\"\ntotal = [0.0, 0.0, 1.0]\n";
  for (const char* method : {"tl-perturbation", "tl-mean-dilatation", "tl-adaptive", "ul-perturbation"}) {
    expect_settled<double>(method, pulled, 0.5);
    expect_settled<float>(method, pulled, 0.5);
  }
  expect_settled<double>("tl-perturbation", loaded, 0.5);
}

/// Nothing moves in equilibrium: forces balance to the search's tolerance, 1e-8 of the reactions. Without the
/// levels of an adaptive answer, or with the previous velocities, the body would move.
TEST(Simulation, rests_after_settling) {
  for (const char* method : {"tl-perturbation", "tl-adaptive"}) {
    Simulation<double> simulation(block(), text_of(pulled), {.method = method});
    simulation.move("head", {0.02, 0.01, 0.03});
    simulation.advance(0.05);
    simulation.settle();
    const NodalField settled = field_of(simulation);
    simulation.advance(0.05);
    EXPECT_LT(largest_distance(field_of(simulation), settled), 1e-7 * 0.03) << method;
  }
}

TEST(Simulation, a_copy_is_a_snapshot_to_the_bit) {
  for (const char* method : {"tl-perturbation", "tl-adaptive", "ul-viscous"}) {
    Simulation<double> simulation(block(), text_of(pulled), {.method = method});
    simulation.move("head", {0.02, 0.01, 0.03});
    simulation.advance(0.1);
    Simulation<double> snapshot(simulation);
    simulation.move("head", {0.0, 0.0, 0.01});
    simulation.advance(0.1);
    const NodalField once = field_of(simulation);
    simulation = snapshot;
    EXPECT_NE(largest_distance(field_of(simulation), once), 0.0);
    simulation.move("head", {0.0, 0.0, 0.01});
    simulation.advance(0.1);
    EXPECT_EQ(largest_distance(field_of(simulation), once), 0.0) << method;
    EXPECT_EQ(simulation.time(), snapshot.time() + (simulation.time() - snapshot.time()));
  }
}

TEST(Simulation, reactions_are_the_internal_forces_on_driven_nodes) {
  Simulation<double> simulation(block(), text_of(pulled));
  simulation.move("head", {0.02, 0.01, 0.03});
  simulation.advance(0.05);
  const Scene scene = read_scene(text_of(pulled), checked(block()));
  const NodalField force = internal_forces(Model(scene, {.method = "tl-perturbation"}), field_of(simulation));
  Vector expected{};
  for (const int n : simulation.nodes("head")) {
    for (std::size_t i = 0; i < 3; ++i) expected[i] += force[index(n)][i];
  }
  EXPECT_GT(expected[2], 0.1);  // it was pulled
  for (std::size_t i = 0; i < 3; ++i) EXPECT_NEAR(simulation.reaction("head")[i], expected[i], 1e-12);
}

/// Two sets share an edge, and each drives one component there.
TEST(Simulation, a_set_moves_only_the_components_imposed_on_it) {
  const std::string sides =
      "[sets.side]\nx = [0.0, 0.0]\n[[displacement]]\nset = \"side\"\nvalue = [0.0, 0.0, 0.0]\n"
      "components = \"x\"\n[[displacement]]\nset = \"head\"\nvalue = [0.0, 0.0, 0.0]\ncomponents = \"z\"\n";
  Simulation<double> simulation(block(), text_of(sides));
  simulation.move("head", {0.0, 0.0, 0.02});
  simulation.move("side", {0.0, 0.0, 0.0});
  simulation.settle();
  const NodalField u = field_of(simulation);
  for (const int n : simulation.nodes("head")) EXPECT_EQ(u[index(n)][2], 0.02);
  EXPECT_EQ(simulation.reaction("side")[2], 0.0);
  EXPECT_NEAR(simulation.reaction("head")[2], -simulation.reaction("foot")[2], 1e-6);
}

TEST(Simulation, single_precision_follows_double) {
  Simulation<double> exact(block(), text_of(pulled));
  Simulation<float> rounded(block(), text_of(pulled));
  for (int n = 1; n <= steps; ++n) {
    for (const auto share = smooth(n * step / 0.2); auto* both : {&exact}) {
      both->move("head", {0.02 * share, 0.01 * share, 0.03 * share});
      rounded.move("head", {0.02 * share, 0.01 * share, 0.03 * share});
    }
    exact.advance(step);
    rounded.advance(step);
  }
  // 200 steps, each rounding displacements of 0.03 m by 2e-9 m at most.
  EXPECT_LT(largest_distance(field_of(rounded), field_of(exact)), 200 * 2e-9);
}

}  // namespace
}  // namespace sandglass::verification::simulation_test
