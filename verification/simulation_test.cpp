/// The library inside a program: the same motion as `integrate`, views, snapshots, errors.

#include <gtest/gtest.h>

#include "io/case_file.hpp"
#include "mesh/vectors.hpp"
#include "sandglass/driven_problem.hpp"
#include "solve/central_difference.hpp"
#include "solve/relaxation.hpp"
#include "solve/steady_step.hpp"
#include "support/allocations.hpp"
#include "support/field_of.hpp"
#include "support/scenes.hpp"
#include "support/temporary_folder.hpp"

namespace sandglass::verification::simulation_test {
namespace {

constexpr double step = 1e-3;  // s; stable for the blocks below
constexpr int steps = 200;

/// A case without a mesh; `driven` is the table of the imposed motion.
std::string text_of(const std::string& driven, const std::string& answer = "dynamic") {
  const std::string dynamics = "[dynamics]\nduration = 0.2\ntime_step = 1e-3\ndamping = 3.0\nframes = 1\n";
  return "[case]\nname = \"block\"\nrequirement = \"A block is moved.\"\nanswer = \"" + answer +
         "\"\n"
         "[material]\nlaw = \"neo-hookean\"\nyoung_modulus = 3000.0\npoisson_ratio = 0.45\ndensity = 1000.0\n"
         "[sets]\nfoot = { z = [0.0, 0.0] }\n[[displacement]]\nset = \"foot\"\nvalue = [0.0, 0.0, 0.0]\n" +
         driven + (answer == "dynamic" ? dynamics : "");
}

const std::string pulled = "[[displacement]]\nset = \"head\"\nvalue = [0.02, 0.01, 0.03]\n";

MeshArrays block() {
  const Mesh mesh = box({0.1, 0.1, 0.2}, {2, 2, 4});
  return {mesh.points,
          mesh.cells,
          {{"head", nodes_where(mesh.points, [](const Vector& X) { return X[2] > 0.19; })}}};
}

/// The motion of a dynamic run.
Motion motion_of(const std::string& text, const MethodChoice& choice) {
  const Scene scene = read_scene(text, checked(block()));
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

/// A ball above the head of the block; more keys may follow.
std::string ball(const std::string& method) {
  return "[[obstacle]]\nname = \"ball\"\nset = \"head\"\nshape = \"sphere\"\nradius = 0.05\n"
         "point = [0.05, 0.04, 0.25]\nmethod = \"" +
         method + "\"\n";
}

/// Friction and inertia make the force depend on the path; both are the same to rounding, which contact
/// amplifies.
TEST(Simulation, moves_obstacles_as_their_paths_in_the_case_do) {
  for (const char* method : {"penalty", "kinematic"}) {
    Simulation<double> by_program(block(), text_of(ball(method) + "friction = 0.3\n"));
    Simulation<double> by_case(
        block(),
        text_of(
            ball(method) +
            "friction = 0.3\ndisplacement = [0.01, 0.0, -0.02]\ntimes = [0.0, 0.1]\nfactors = [0.0, 1.0]\n"));
    by_program.move("ball", {0.01, 0.0, -0.02});
    TemporaryFolder folder;
    by_program.save(folder / "before");
    for (int again = 0; again < 2; ++again) {
      by_program.advance(0.1);
      if (again == 0) by_case.advance(0.1);
      EXPECT_GT(length(by_case.reaction("ball")), 0.01);
      EXPECT_LT(distance(by_program.reaction("ball"), by_case.reaction("ball")), 1e-9) << method;
      EXPECT_LT(distance(by_program.moment("ball"), by_case.moment("ball")), 1e-11) << method;
      EXPECT_LT(largest_distance(field_of(by_program), field_of(by_case)), 1e-12) << method;
      by_program.resume(folder / "before");
    }
  }
}

/// The two ends of a capsule are the same obstacle with another point: moments differ by that of the force. A
/// ball without friction has none about its centre.
TEST(Simulation, the_moment_of_an_obstacle_is_about_its_point) {
  const std::string rod =
      "[[obstacle]]\nname = \"rod\"\nset = \"head\"\nshape = \"capsule\"\nradius = 0.05\nmethod = ";
  const auto pressed = [&](const std::string& method, const std::string& ends) {
    Simulation<double> simulation(block(), text_of(rod + "\"" + method + "\"\n" + ends));
    simulation.move("rod", {0.01, 0.0, -0.02});
    simulation.advance(0.1);
    return simulation;
  };
  for (const char* method : {"penalty", "kinematic"}) {
    const auto forth = pressed(method, "point = [0.02, 0.04, 0.25]\nend = [0.09, 0.04, 0.30]\n"),
               back = pressed(method, "point = [0.09, 0.04, 0.30]\nend = [0.02, 0.04, 0.25]\n");
    const Vector force = forth.reaction("rod"), way{0.07, 0.0, 0.05};
    EXPECT_GT(length(force), 0.01) << method;
    const Vector expected = sum(back.moment("rod"), 1.0, cross(way, force));
    EXPECT_LT(distance(forth.moment("rod"), expected), 1e-9) << method;
    EXPECT_GT(length(back.moment("rod")), 1e-4) << method;
  }
  const Simulation<double> round = [] {
    Simulation<double> simulation(block(), text_of(ball("penalty")));
    simulation.move("ball", {0.01, 0.0, -0.02});
    simulation.advance(0.1);
    return simulation;
  }();
  EXPECT_GT(length(round.reaction("ball")), 0.01);
  EXPECT_LT(length(round.moment("ball")), 1e-15);
}

TEST(Simulation, settles_under_an_obstacle_that_it_moved) {
  Simulation<double> by_program(block(), text_of(ball("penalty")));
  Simulation<double> by_case(block(), text_of(ball("penalty") + "displacement = [0.0, 0.0, -0.02]\n"));
  for (Simulation<double>* one : {&by_program, &by_case}) {
    if (one == &by_program)
      one->move("ball", {0.0, 0.0, -0.02});
    else
      one->impose(1.0);
    one->settle();
  }
  EXPECT_GT(length(by_case.reaction("ball")), 0.01);
  EXPECT_LT(distance(by_program.reaction("ball"), by_case.reaction("ball")), 1e-9);
  EXPECT_LT(distance(by_program.moment("ball"), by_case.moment("ball")), 1e-11);
  EXPECT_LT(largest_distance(field_of(by_program), field_of(by_case)), 1e-12);
  for (Simulation<double>* one : {&by_program, &by_case}) one->advance(0.05);  // the ball stays where it is
  EXPECT_LT(largest_distance(field_of(by_program), field_of(by_case)), 1e-12);
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

TEST(Simulation, without_equilibrium_it_stays_as_it_was) {
  const std::string impatient = "[relaxation]\nmax_steps = 3\n";
  Simulation<double> simulation(block(), text_of(pulled) + impatient);
  simulation.impose(1.0);
  simulation.advance(0.05);
  const NodalField before = field_of(simulation);
  EXPECT_THROW(simulation.settle(), ComputationError);
  EXPECT_EQ(field_of(simulation), before);
  simulation.advance(0.01);
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

/// Nodes between foot and head move only along z, so that no element can escape sideways.
const std::string guided = pulled +
                           "[sets.inside]\nz = [0.01, 0.19]\n[[displacement]]\nset = \"inside\"\n"
                           "value = [0.0, 0.0, 0.0]\ncomponents = \"xy\"\n";

/// A push that turns elements inside out with steps of any length, or makes steps collapse, ends at a check;
/// the body then returns to its state at the check before.
template <class Real>
void expect_return(const char* method) {
  SCOPED_TRACE(method);
  constexpr double frame = 0.18;  // s
  const Vector gone{0.0, 0.0, -0.5};
  Simulation<Real> simulation(block(), text_of(guided) + "check_interval = 5\n", {.method = method});
  const auto* const before = simulation.displacements().data;
  simulation.move("head", gone);
  std::string message;
  try {
    simulation.advance(frame);
  } catch (const ComputationError& error) {
    message = error.what();
  }
  const double whole = simulation.time();
  ASSERT_GT(whole, 0.0);
  ASSERT_LT(whole, frame);
  EXPECT_PRED_FORMAT2(::testing::IsSubstring, "element ", message);
  EXPECT_PRED_FORMAT2(::testing::IsSubstring, fmt::format("is back at {:.6g} s", whole), message);
  EXPECT_EQ(simulation.displacements().data, before);
  // Driven nodes stay until they get a new target, and the failure leaves no trace.
  const auto node = index(simulation.nodes("head")[0]);
  const Vector head = field_of(simulation)[node];
  EXPECT_NEAR(head[2], gone[2] * whole / frame, 1e-6);  // on a straight path, in single precision
  simulation.advance(0.1 * simulation.step_size());
  EXPECT_EQ(field_of(simulation)[node], head);
  simulation.move("head", {0.0, 0.0, -0.02});
  simulation.settle();
  simulation.advance(0.1);
  for (const Vector& u : field_of(simulation)) EXPECT_LT(length(u), 0.03);
}

TEST(Simulation, returns_to_its_last_whole_state_when_an_element_turns_inside_out) {
  for (const char* method : {"tl-perturbation", "tl-adaptive", "ul-viscous"}) {
    expect_return<double>(method);
    expect_return<float>(method);
  }
}

TEST(Simulation, before_the_first_check_it_returns_to_the_start_or_to_where_it_settled) {
  Simulation<double> simulation(block(), text_of(guided));
  simulation.move("head", {0.0, 0.0, -5.0});  // upside down within the twenty shortest steps too
  EXPECT_THROW(simulation.advance(0.12), ComputationError);
  EXPECT_EQ(simulation.time(), 0.0);
  EXPECT_EQ(field_of(simulation), NodalField(45));
  simulation.move("head", {0.02, 0.01, 0.03});
  simulation.settle();
  const NodalField settled = field_of(simulation);
  simulation.move("head", {0.0, 0.0, -5.0});
  EXPECT_THROW(simulation.advance(0.15), ComputationError);
  EXPECT_EQ(field_of(simulation), settled);
}

/// The head is pressed so fast that elements turn inside out before a check, but not with shorter steps:
/// these replace them, up to the same time and position.
TEST(Simulation, takes_steps_that_prove_too_long_again) {
  for (const auto& [pressed, seconds] : {std::pair{0.09, 0.05}, {0.13, 0.15}}) {
    Simulation<double> simulation(block(), text_of(pulled),
                                  {.method = "tl-mean-dilatation", .step_fraction = 1.0});
    simulation.move("head", {0.0, 0.0, -pressed});
    simulation.advance(seconds);
    simulation.advance(0.1);
    EXPECT_NEAR(simulation.time(), seconds + 0.1, 1e-12);
    EXPECT_EQ(field_of(simulation)[index(simulation.nodes("head")[0])], (Vector{0.0, 0.0, -pressed}));
  }
}

TEST(Simulation, refuses_what_makes_no_sense) {
  using ::testing::IsSubstring;
  Simulation<double> simulation(block(), text_of(pulled + "[sets.side]\nx = [0.1, 0.1]\ny = [0.05, 0.05]\n"
                                                          "z = [0.05, 0.15]\n"));
  const auto says = [](const std::string& part, const std::string& text) {
    EXPECT_PRED_FORMAT2(IsSubstring, part, text);
  };
  const Vector up{0.0, 0.0, 0.01};
  says("did you mean 'head'", input_error([&] { simulation.move("haed", up); }));
  says("imposes no displacement", input_error([&] { simulation.move("side", up); }));
  says("imposes no displacement", input_error([&] { simulation.reaction("side"); }));
  says("is not known", input_error([&] { simulation.nodes("haed"); }));
  says("one for each of its 9 nodes", input_error([&] { simulation.move("head", std::vector<Vector>(8)); }));
  says("must be in", input_error([&] { simulation.move("head", {0.0, std::nan(""), 0.0}); }));
  says("must be in", input_error([&] { simulation.impose(std::nan("")); }));
  for (const double seconds : {0.0, -1.0, std::nan("")}) {
    says("seconds", input_error([&] { simulation.advance(seconds); }));
  }
  Simulation<double> touched(block(), text_of(ball("penalty")));
  says("obstacle 'ball': 2 displacements",
       input_error([&] { touched.move("ball", std::vector<Vector>(2)); }));
  says("did you mean 'ball'", input_error([&] { touched.move("bal", up); }));
  says("did you mean 'ball'", input_error([&] { touched.moment("bal"); }));
  const auto made = [](const SimulationSettings& settings) {
    return input_error([&] { Simulation<double>(block(), text_of(pulled), settings); });
  };
  says("step_fraction", made({.step_fraction = 1.5}));
  says("damping", made({.damping = -1.0}));
  says("threads", made({.threads = 0}));
  says("'tl-nothing' is not known", made({.method = "tl-nothing"}));
  says("no dynamics", made({.method = "linear-condensed"}));
}

TEST(Simulation, refuses_meshes_that_are_none) {
  using ::testing::IsSubstring;
  const auto refused = [](const std::string& part, const auto& spoil, const std::string& text) {
    MeshArrays mesh = block();
    spoil(mesh);
    EXPECT_PRED_FORMAT2(IsSubstring, part, input_error([&] { Simulation<double>(mesh, text); }));
  };
  const std::string text = text_of(pulled);
  refused(
      "cell 3 names node 45; it must be in [0, 45)", [](auto& mesh) { mesh.cells[3][2] = 45; }, text);
  refused(
      "set 'head' names node -1", [](auto& mesh) { mesh.sets["head"][0] = -1; }, text);
  refused(
      "node 45 of 46 belongs to no cell", [](auto& mesh) { mesh.points.push_back({}); }, text);
  refused(
      "belongs to no cell", [](auto& mesh) { mesh = {}; }, text);
  refused(
      "inverted", [](auto& mesh) { std::swap(mesh.cells[0][0], mesh.cells[0][1]); }, text);
  refused(
      "node 0 is at nan", [](auto& mesh) { mesh.points[0][0] = std::nan(""); }, text);
  const auto same = [](auto&) {};
  refused("mesh is not allowed here", same, text + "[mesh]\ngenerator = \"box\"\n");
  refused("case text:", same, text + "[meterial]\n");
  refused("is not TOML", same, "[case");
}

}  // namespace
}  // namespace sandglass::verification::simulation_test
