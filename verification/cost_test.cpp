/// The costs of a step, a simulated second and an equilibrium: each figure measures what its name says.

#include "benchmark/cost.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "base/error.hpp"
#include "benchmark/own_motion.hpp"
#include "benchmark/stepped_model.hpp"
#include "comparison/answer.hpp"
#include "counting/program_shape.hpp"
#include "io/case_file.hpp"
#include "mesh/box.hpp"
#include "sandglass/driven_problem.hpp"
#include "sandglass/simulation.hpp"
#include "solve/stable_step.hpp"
#include "support/case_text.hpp"
#include "support/scenes.hpp"

namespace sandglass::verification::cost_test {
namespace {

bool proceed(double /*share*/) {
  return true;
}

MeshArrays block(const std::array<int, 3>& elements = {2, 2, 4}) {
  const Mesh mesh = box({0.1, 0.1, 0.2}, elements);
  return {mesh.points,
          mesh.cells,
          {{"head", nodes_where(mesh.points, [](const Vector& X) { return X[2] > 0.19; })}}};
}

/// A block with a loaded head, without its mesh; so light that its own motion takes .12 s instead of about
/// the second of a curve over the share of the load.
std::string text_of(const std::string& load) {
  const std::string whole =
      replaced(box_case("block", "[1.0, 1.0, 1.0]", "[1, 1, 1]"), "density = 1000.0", "density = 10.0");
  const std::size_t mesh = whole.find("[mesh]"), material = whole.find("[material]");
  return whole.substr(0, mesh) + whole.substr(material) +
         "[sets]\nfoot = { z = [0.0, 0.0] }\n[[displacement]]\nset = \"foot\"\nvalue = [0.0, 0.0, 0.0]\n" +
         load;
}

std::string pressed(double depth) {
  return fmt::format("[[displacement]]\nset = \"head\"\nvalue = [0.0, 0.0, {}]\n", -depth);
}

Scene scene_of(const std::string& load) {
  return read_scene(text_of(load), checked(block()));
}

double smooth(double t) {
  return t * t * t * (10.0 + t * (6.0 * t - 15.0));
}

/// The mean step of a simulation that a program drives along the loading curve: time over number of steps.
double mean_step_of_simulation(const std::string& method, const std::string& load, double duration,
                               double damping) {
  Simulation<double> simulation(block(), text_of(load), {.method = method, .damping = damping});
  long steps = 0;
  while (simulation.time() < duration) {
    const double step = simulation.step_size();
    simulation.impose(smooth((simulation.time() + step) / duration));
    simulation.advance(step);
    ++steps;
  }
  return simulation.time() / static_cast<double>(steps);
}

class OwnMotionTest : public ::testing::TestWithParam<const char*> {};

/// The cost uses the steps of the motion. For a block pressed by 40 % the mean step lies between those at
/// both ends and equals that of a simulation: both choose steps alike and differ only by the last one, which
/// ends at the duration. A slower motion has the same mean step, so speed does not matter.
TEST_P(OwnMotionTest, has_the_steps_of_a_simulation) {
  const Scene scene = scene_of(pressed(0.08));
  const MethodChoice choice{.method = GetParam()};
  const OwnMotion motion = follow_own_motion(scene, choice, proceed);
  ASSERT_TRUE(motion.mean_step) << motion.remark;
  const double crossing = crossing_time(scene);
  EXPECT_NEAR(crossing, std::sqrt(0.1 * 0.1 + 0.1 * 0.1 + 0.2 * 0.2) / std::sqrt(3000.0 / 2.98 / 10.0),
              1e-12);
  const double simulated = mean_step_of_simulation(GetParam(), pressed(0.08), own_motion_crossings * crossing,
                                                   own_motion_damping / crossing);
  // A run divides the time left into equal steps, so that each change shortens them by up to one part of
  // their number.
  EXPECT_NEAR(*motion.mean_step, simulated, 0.015 * simulated);
  const double slower =
      mean_step_of_simulation(GetParam(), pressed(0.08), 7.0 * crossing, own_motion_damping / crossing);
  // Over a shorter motion, the cautious steps of the first half crossing count twice as much.
  EXPECT_NEAR(*motion.mean_step, slower, 0.04 * slower);
  const Model model(scene, choice);
  const double undeformed_step = 0.9 * stable_step(model, NodalField(scene.mesh.points.size())).step;
  const double at_end = 0.9 * stable_step(model, motion.end).step;
  EXPECT_LT(at_end, 0.8 * undeformed_step);  // otherwise the test could not distinguish them
  EXPECT_LT(*motion.mean_step, 0.95 * undeformed_step);
  EXPECT_GT(*motion.mean_step, 1.05 * at_end);
}

INSTANTIATE_TEST_SUITE_P(Methods, OwnMotionTest,
                         ::testing::Values("tl-perturbation", "ul-perturbation", "tl-mean-dilatation"),
                         [](const auto& named) {
                           std::string name = named.param;
                           std::replace(name.begin(), name.end(), '-', '_');
                           return name;
                         });

/// Elements of an adaptive method change levels during the motion: steps are timed with the levels at several
/// times, not only at the end, and the cost includes the checks of levels. Other methods have one state.
TEST(OwnMotion, keeps_levels_on_the_way) {
  const Scene scene = scene_of(pressed(0.08));
  const MethodChoice adaptive{.method = "tl-adaptive", .accuracy = 0.01};
  const OwnMotion motion = follow_own_motion(scene, adaptive, proceed);
  ASSERT_EQ(motion.levels.size(), levels_on_the_way);
  const auto sum = [](const std::vector<double>& levels) {
    return std::accumulate(levels.begin(), levels.end(), 0.0);
  };
  EXPECT_LT(sum(motion.levels.front()), 0.5 * sum(motion.levels.back()));
  EXPECT_GT(sum(motion.levels.back()), 0.0);
  EXPECT_TRUE(std::is_sorted(motion.levels.begin(), motion.levels.end(),
                             [&](const auto& a, const auto& b) { return sum(a) < sum(b); }));
  EXPECT_EQ(make_stepped_model(scene, adaptive, &motion)->states(), levels_on_the_way);
  EXPECT_GT(motion.adaption, 0.0);
  const Timing timing{.status = "ok",
                      .force_difference = 0.0,
                      .seconds_per_step = {},
                      .seconds_of_a_step = {},
                      .seconds_of_a_check = {2.0}};
  EXPECT_DOUBLE_EQ(checks_per_step(timing, scene, &motion),
                   2.0 / scene.settings.dynamics.check_interval + motion.adaption);
  const OwnMotion plain = follow_own_motion(scene, {"tl-perturbation"}, proceed);
  EXPECT_EQ(make_stepped_model(scene, {"tl-perturbation"}, &plain)->states(), 1U);
}

/// The slow, damped motion ends near the equilibrium. Curves over the share of the load are followed too:
/// with one that returns to zero, the body returns as well.
TEST(OwnMotion, ends_near_the_equilibrium) {
  Observer silent;
  const std::string force = "[[force]]\nset = \"head\"\ntotal = [0.0, 0.0, 2.0]\n";
  const Scene scene = scene_of(force);
  const NodalField rest = compute_answer(scene, {"tl-perturbation"}, silent).u.back();
  const NodalField unloaded(rest.size());
  const double largest = largest_distance(rest, unloaded);
  const OwnMotion motion = follow_own_motion(scene, {"tl-perturbation"}, proceed);
  EXPECT_LT(largest_distance(motion.end, rest), 0.05 * largest);
  const Scene returns = scene_of(force + "times = [0.0, 0.5, 1.0]\nfactors = [0.0, 1.0, 0.0]\n");
  const OwnMotion back = follow_own_motion(returns, {"tl-perturbation"}, proceed);
  EXPECT_LT(largest_distance(back.end, unloaded), 0.2 * largest);
  const Scene formula = scene_of(force + "formula = \"t * (2 - t)\"\n");
  EXPECT_LT(largest_distance(follow_own_motion(formula, {"tl-perturbation"}, proceed).end, rest),
            0.05 * largest);
}

/// An element all of whose nodes are driven has no motion and no cost of a simulated second; the reason is
/// given.
TEST(OwnMotion, says_why_it_fails) {
  const Scene scene = read_scene(text_of(pressed(0.25)), checked(block({1, 1, 1})));
  const OwnMotion motion = follow_own_motion(scene, {"tl-perturbation"}, proceed);
  EXPECT_FALSE(motion.mean_step);
  EXPECT_TRUE(motion.end.empty());
  EXPECT_FALSE(motion.remark.empty());
  const std::vector<CostTask> tasks{{&scene, {"tl-perturbation"}, &motion}};
  const auto costings = measure_costs(tasks, proceed);
  ASSERT_TRUE(costings[0].cost) << costings[0].status;
  EXPECT_GT(costings[0].cost->seconds, 0.0);
  EXPECT_FALSE(costings[0].cost->per_simulated_second());
  EXPECT_EQ(costings[0].cost->remark, motion.remark);
}

TEST(OwnMotion, ends_when_interrupted) {
  const Scene scene = scene_of(pressed(0.02));
  EXPECT_THROW(follow_own_motion(scene, {"tl-perturbation"}, [](double) { return false; }), ComputationError);
}

/// The own motion of a dynamic case is the case itself.
TEST(OwnMotion, of_a_dynamic_case_is_the_case) {
  Scene scene = scene_of(pressed(0.02));
  scene.settings.quasi_static = false;
  scene.settings.dynamics = {.duration = 0.05, .time_step = 1e-4};
  EXPECT_NEAR(*follow_own_motion(scene, {"tl-perturbation"}, proceed).mean_step, 1e-4, 1e-13);
}

/// A simulated second costs as much as its steps, or a thousand answers of a condensed method; the cost does
/// not depend on kappa.
TEST(StepCost, follows_from_step_and_mean_step) {
  const Scene scene = scene_of(pressed(0.02));
  const OwnMotion motion = follow_own_motion(scene, {"tl-perturbation"}, proceed);
  const std::vector<CostTask> tasks{{&scene, {"tl-perturbation"}, &motion},
                                    {&scene, {.method = "tl-perturbation", .kappa = 0.1}, &motion},
                                    {&scene, {"linear-condensed"}}};
  const auto costings = measure_costs(tasks, proceed);
  for (const auto& costing : costings) {
    ASSERT_TRUE(costing.cost) << costing.status;
    EXPECT_GT(costing.cost->lower_quartile, 0.0);
    EXPECT_LE(costing.cost->lower_quartile, costing.cost->seconds);
    EXPECT_LE(costing.cost->seconds, costing.cost->upper_quartile);
  }
  const StepCost& step = *costings[0].cost;
  EXPECT_DOUBLE_EQ(*step.per_simulated_second(), (step.seconds + step.checks) / *motion.mean_step);
  EXPECT_GT(step.checks, 0.0);
  EXPECT_EQ(costings[1].cost->seconds, step.seconds);
  EXPECT_FALSE(costings[2].cost->mean_step);
  EXPECT_DOUBLE_EQ(*costings[2].cost->per_simulated_second(), 1000.0 * costings[2].cost->seconds);
}

/// p = a b is needed twice, so only the product q d goes into a difference; each operation needs the one
/// before; p waits beside q, then beside q d. Shared operations and what no result needs do not count.
TEST(ProgramShape, of_four_operations) {
  Tape tape;
  const Recorded a = tape.input(), b = tape.input(), c = tape.input(), d = tape.input();
  const Recorded p = a * b, q = b * a + c;
  static_cast<void>(a / d);  // no result needs it
  const ProgramShape shape = shape_of(tape.program({p - q * d}));
  EXPECT_EQ(shape.operations, 4);
  EXPECT_EQ(shape.fused, 1);
  EXPECT_EQ(shape.instructions(), 3);
  EXPECT_EQ(shape.chain, 4);
  EXPECT_EQ(shape.alive, 2);
  EXPECT_DOUBLE_EQ(shape.peak_share(), 2.0 / 3.0);
}

}  // namespace
}  // namespace sandglass::verification::cost_test
