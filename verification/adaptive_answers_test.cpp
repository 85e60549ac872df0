/// Answers of the adaptive method: the meaning of the requested accuracy, at rest and in motion, and the
/// error estimate.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "solve/adaption.hpp"
#include "solve/central_difference.hpp"
#include "solve/error_estimate.hpp"
#include "solve/relaxation.hpp"
#include "support/level_kernels.hpp"
#include "support/pressed_block.hpp"
#include "support/scenes.hpp"
#include "support/static_answer.hpp"

namespace sandglass::verification::adaptive_answers_test {
namespace {

double distance(const Scene& scene, const NodalField& a, const NodalField& b) {
  return largest_distance(a, b) / largest_imposed(scene);
}

/// The error stays below the requested accuracy. A low accuracy gives the lowest level, a very high one the
/// highest. Answers balance to 1e-8 of the forces.
TEST(Adaptive, answers_are_as_near_as_asked_for) {
  const Scene scene = pressed_block(0.02);
  const NodalField exact = static_answer(scene, {"tl-mean-dilatation"}).u;
  for (const double accuracy : {0.05, 0.01, 0.003, 0.001}) {
    const NodalField u = static_answer(scene, {.method = "tl-adaptive", .accuracy = accuracy}).u;
    EXPECT_LT(distance(scene, u, exact), accuracy) << accuracy;
  }
  const NodalField low = static_answer(scene, {"tl-modal-sampling"}).u;
  EXPECT_GT(distance(scene, low, exact), 0.005) << "the scene asks for nothing";
  EXPECT_LT(distance(scene, static_answer(scene, {.method = "tl-adaptive", .accuracy = 1e9}).u, low), 1e-7);
  const NodalField high = static_answer(scene, {.method = "tl-adaptive", .accuracy = 1e-12}).u;
  EXPECT_LT(distance(scene, high, exact), 1e-7);
}

/// Keeps the frames and the largest difference between energy and work.
class FrameRecorder final : public Observer {
 public:
  void frame(const Frame& frame) override { frames.push_back(frame); }
  void history(const HistoryRow& row) override {
    work = std::max(work, std::abs(row.external_work));
    const double energy = row.kinetic + row.strain + row.hourglass;
    imbalance = std::max(imbalance, std::abs(energy - row.external_work));
    unexplained = std::max(unexplained, std::abs(energy - row.external_work - row.adaption));
  }
  std::vector<Frame> frames;
  double work = 0.0;         ///< J, largest
  double imbalance = 0.0;    ///< J
  double unexplained = 0.0;  ///< J, part of the imbalance that changes of level do not explain
};

/// The answer is in equilibrium at the levels reported with it, and no element needs a higher level.
TEST(Adaptive, answers_rest_at_their_levels) {
  const Scene scene = pressed_block(0.02);
  const MethodChoice choice{.method = "tl-adaptive", .accuracy = 0.005};
  const Model model(scene, choice);
  FrameRecorder recorder;
  ASSERT_TRUE(relax(model, recorder).converged);
  const auto& elements = elements_of(model);
  Body<double> body(model, elements);
  body.state() = state_at(elements, recorder.frames.back().u);
  elements.set_levels(body.state(), recorder.frames.back().levels);
  body.impose(1.0);
  body.evaluate_forces();
  EXPECT_LT(body.residual(), 1.01 * scene.settings.relaxation.tolerance);
  EXPECT_GT(std::count(recorder.frames.back().levels.begin(), recorder.frames.back().levels.end(), 2.0), 0);
  EXPECT_EQ(Adaption<double>(model, body).apply(body, Demotion::never).promoted, 0U);
}

/// In motion, elements only move to higher levels. Each change adds the difference of the element's energies,
/// the work of a difference of forces that the accuracy keeps small. A bent beam that vibrates for many
/// periods, until most of its elements have changed, gains 10 times the accuracy of the work put into it; if
/// elements could return to lower levels, it would gain without end. The history reports that gain. The rest
/// is the imbalance of a fixed method, whose energy oscillates by the square of the step, plus half a step's
/// change of velocities where forces jump, 2.7 times as much together.
TEST(Adaptive, motion_keeps_its_energy) {
  Case description = plain_case(level_law());
  const Mesh mesh = box({0.02, 0.02, 0.1}, {3, 3, 12});
  const NodeSets sets{{"foot", nodes_where(mesh.points, [](const Vector& X) { return X[2] == 0.0; })},
                      {"head", nodes_where(mesh.points, [](const Vector& X) { return X[2] > 0.099; })}};
  description.displacements = {{"foot", {}}, {"head", {0.05, 0.0, 0.02}}};
  description.quasi_static = false;
  description.dynamics.duration = 1.0;
  description.dynamics.ramp_time = 0.1;
  const Scene scene = make_scene(description, mesh, sets);
  FrameRecorder fixed;
  integrate(Model(scene, {"tl-mean-dilatation"}), fixed);
  for (const double accuracy : {0.01, 0.003}) {
    FrameRecorder recorder;
    integrate(Model(scene, {.method = "tl-adaptive", .accuracy = accuracy}), recorder);
    EXPECT_LT(recorder.imbalance / recorder.work, fixed.imbalance / fixed.work + 12.0 * accuracy) << accuracy;
    EXPECT_LT(recorder.unexplained / recorder.work, 4.0 * fixed.imbalance / fixed.work) << accuracy;
    RecordProperty("unexplained over work, accuracy " + std::to_string(accuracy),
                   std::to_string(recorder.unexplained / recorder.work));
    RecordProperty("imbalance over work, accuracy " + std::to_string(accuracy),
                   std::to_string(recorder.imbalance / recorder.work));
    for (std::size_t n = 1; n < recorder.frames.size(); ++n) {
      const auto &before = recorder.frames[n - 1].levels, &now = recorder.frames[n].levels;
      EXPECT_TRUE(std::equal(now.begin(), now.end(), before.begin(), std::greater_equal{}));
    }
    EXPECT_GT(recorder.frames.back().levels, recorder.frames.front().levels) << "nothing was adapted";
  }
}

/// Single precision stops at its roundoff, and its elements settle only then: answers are as accurate, and
/// levels equal, or higher because there are more lanes to fill. Lower ones are those that roundoff decides,
/// together with their mirror images.
TEST(Adaptive, floats_settle_too) {
  const Scene scene = pressed_block(0.02);
  const NodalField exact = static_answer(scene, {"tl-mean-dilatation"}).u;
  for (const double accuracy : {0.01, 0.003}) {
    FrameRecorder in_double, in_float;
    MethodChoice choice{.method = "tl-adaptive", .accuracy = accuracy};
    relax(Model(scene, choice), in_double);
    choice.precision = Precision::single_precision;
    const Relaxation answer = relax(Model(scene, choice), in_float);
    EXPECT_TRUE(in_equilibrium(answer));
    EXPECT_LT(distance(scene, answer.u, exact), accuracy) << accuracy;
    int lower = 0;
    const auto &a = in_double.frames.back().levels, &b = in_float.frames.back().levels;
    for (std::size_t e = 0; e < a.size(); ++e) lower += b[e] < a[e] ? 1 : 0;
    EXPECT_LE(lower, static_cast<int>(a.size() / 20)) << accuracy;
  }
}

/// With forces alone, the largest displacement takes the place of the imposed one.
TEST(Adaptive, forces_alone_wake_elements_too) {
  CaseOnMesh problem = pressed_block_case(0.0);
  problem.description.displacements.pop_back();
  problem.description.forces.of<DeadForce>() = {{"pressed", {0.0, 0.0, -0.25}, {}}};
  const Scene scene = make_scene(problem);
  const NodalField exact = static_answer(scene, {"tl-mean-dilatation"}).u;
  const double unit = displacement_unit(scene, exact);
  const NodalField u = static_answer(scene, {.method = "tl-adaptive", .accuracy = 0.002}).u;
  EXPECT_LT(largest_distance(u, exact), 0.002 * unit);
  EXPECT_GT(largest_distance(static_answer(scene, {"tl-modal-sampling"}).u, exact), 3.0 * 0.002 * unit);
}

/// Along a beam bent by a pressure, the errors of elements add up to several times the error that each is
/// allowed. The answer is still as accurate as requested, at higher levels than single elements need.
TEST(Adaptive, errors_that_add_up_count_as_a_whole) {
  Case description = plain_case(level_law());
  const Mesh mesh = box({0.02, 0.02, 0.1}, {4, 4, 20});
  const NodeSets sets{{"foot", nodes_where(mesh.points, [](const Vector& X) { return X[2] == 0.0; })},
                      {"side", nodes_where(mesh.points, [](const Vector& X) { return X[0] == 0.0; })}};
  description.displacements = {{"foot", {}}};
  description.forces.of<Pressure>() = {{"side", 3.0}};
  const Scene scene = make_scene(description, mesh, sets);
  const NodalField exact = static_answer(scene, {"tl-mean-dilatation"}).u;
  const double unit = displacement_unit(scene, exact);
  const MethodChoice choice{.method = "tl-adaptive", .accuracy = 0.003};
  const Model model(scene, choice);
  FrameRecorder recorder;
  const Relaxation answer = relax(model, recorder);
  EXPECT_TRUE(answer.converged);
  EXPECT_LT(largest_distance(answer.u, exact), choice.accuracy * unit);
  const auto& elements = elements_of(model);
  Body<double> body(model, elements);
  body.state() = state_at(elements, answer.u);
  elements.set_levels(body.state(), recorder.frames.back().levels);
  EXPECT_GT(Adaption<double>(model, body).apply(body, Demotion::where_enough).demoted,
            mesh.cells.size() / 20);
}

/// The estimate is the error of any method, up to the hundredth of the forces at which its solution stops.
TEST(ErrorEstimate, is_the_error) {
  const Scene scene = pressed_block(0.02);
  const NodalField exact = static_answer(scene, {"tl-mean-dilatation"}).u;
  for (const auto* method : {"tl-perturbation", "tl-full", "tl-four-point", "tl-adaptive"}) {
    const MethodChoice choice{.method = method, .accuracy = 0.01};
    const NodalField u = static_answer(scene, choice).u;
    const ErrorEstimate estimate = estimate_error(Model(scene, choice), u);
    EXPECT_NEAR(estimate.largest / largest_distance(u, exact), 1.0, 0.05) << method;
    double squares = 0.0;
    for (std::size_t n = 0; n < u.size(); ++n) squares += std::pow(sandglass::distance(u[n], exact[n]), 2);
    EXPECT_NEAR(estimate.rms / std::sqrt(squares / static_cast<double>(u.size())), 1.0, 0.05) << method;
  }
  EXPECT_LT(estimate_error(Model(scene, {"tl-mean-dilatation"}), exact).largest,
            1e-7 * largest_imposed(scene));
}

}  // namespace
}  // namespace sandglass::verification::adaptive_answers_test
