/// Steppers: guarantees about residuals, determinism and failures.

#include <gtest/gtest.h>

#include "base/error.hpp"
#include "solve/central_difference.hpp"
#include "solve/relaxation.hpp"
#include "solve/stable_step.hpp"
#include "support/method_test.hpp"
#include "support/random_hexahedra.hpp"
#include "support/scenes.hpp"
#include "support/temporary_folder.hpp"

namespace sandglass::verification::stepping_test {
namespace {

/// A block on its foot whose head is moved by `d`.
Scene driven_block(const Vector& d, double nu = 0.49) {
  Case description = plain_case(sample_law<NeoHookean>(nu));
  const Mesh mesh = box({0.1, 0.1, 0.2}, {2, 2, 4});
  const NodeSets sets{{"foot", nodes_where(mesh.points, [](const Vector& X) { return X[2] == 0.0; })},
                      {"head", nodes_where(mesh.points, [](const Vector& X) { return X[2] > 0.19; })}};
  description.displacements = {{"foot", {}}, {"head", d}};
  return make_scene(description, mesh, sets);
}

/// A block of 648 elements and 931 nodes, bent and stretched.
Scene long_block() {
  Case description = plain_case(sample_law<NeoHookean>(0.49));
  const Mesh mesh = box({0.1, 0.1, 0.3}, {6, 6, 18});
  const NodeSets sets{{"foot", nodes_where(mesh.points, [](const Vector& X) { return X[2] == 0.0; })},
                      {"head", nodes_where(mesh.points, [](const Vector& X) { return X[2] > 0.29; })}};
  description.displacements = {{"foot", {}}, {"head", {0.04, 0.0, 0.03}}};
  return make_scene(description, mesh, sets);
}

/// Recomputes |free forces| / |reactions| from the forces alone.
double residual_of(const Model& model, const NodalField& u) {
  NodalField force = internal_forces(model, u);
  double carried = 0.0;
  for (const auto& c : model.scene().constraints) {
    double& f = force[index(c.node)][index(c.component)];
    carried += f * f;
    f = 0.0;
  }
  double unbalanced = 0.0;
  for (const auto& f : force) unbalanced += f[0] * f[0] + f[1] * f[1] + f[2] * f[2];
  return std::sqrt(unbalanced / carried);
}

class StepperTest : public MethodTest {};

INSTANTIATE_TEST_SUITE_P(, StepperTest, each_of(SteppedMethods{}), method_label);

TEST_P(StepperTest, relaxation_ends_in_equilibrium_with_the_imposed_displacements) {
  const Vector d{0.04, 0.0, 0.03};
  const Scene scene = driven_block(d);
  const Model model(scene, choice());
  Recorder recorder;
  const Relaxation answer = relax(model, recorder);
  ASSERT_TRUE(answer.converged);
  EXPECT_LT(answer.residual, 1e-8);
  // The reported residual is that of the returned displacements, up to roundoff of sums in another order.
  EXPECT_NEAR(residual_of(model, answer.u), answer.residual, 1e-12);
  for (const int n : scene.sets.at("head")) EXPECT_EQ(answer.u[index(n)], d);
  for (const int n : scene.sets.at("foot")) EXPECT_EQ(answer.u[index(n)], Vector{});
  ASSERT_GE(recorder.frames.size(), 2U);
  EXPECT_EQ(recorder.frames.front().time, 0.0);  // the initial state comes first
  EXPECT_EQ(largest_distance(recorder.frames.front().u, NodalField(answer.u.size())), 0.0);
  EXPECT_EQ(recorder.frames.back().u, answer.u);
  for (std::size_t n = 1; n < recorder.frames.size(); ++n) {
    EXPECT_GT(recorder.frames[n].time, recorder.frames[n - 1].time);
  }
}

/// When evaluations run out, the current displacements are returned: they approach the answer from the first
/// guess on, and with as many evaluations as the answer took they equal it, bit by bit.
TEST_P(StepperTest, relaxation_returns_where_it_is_when_steps_run_out) {
  if (method.pressure_varies) GTEST_SKIP() << "its steps take many evaluations each";
  Scene scene = driven_block({0.04, 0.0, 0.03});
  const Model model(scene, choice());
  Observer silent;
  const Relaxation answer = relax(model, silent);
  double before = std::numeric_limits<double>::infinity();
  for (const long share : {0L, 50L, 75L, 95L}) {
    scene.settings.relaxation.max_steps = static_cast<int>(answer.steps * share / 100);
    const Relaxation part = relax(model, silent);
    EXPECT_FALSE(part.converged);
    const double distance = largest_distance(part.u, answer.u);
    EXPECT_GT(distance, 0.0);
    EXPECT_LT(distance, before);
    before = distance;
  }
  scene.settings.relaxation.max_steps = static_cast<int>(answer.steps);
  EXPECT_EQ(relax(model, silent).u, answer.u);
}

/// The answer does not depend on the path: other load levels give the same displacements. Modes without
/// energy have no unique answer and keep the path's.
TEST_P(StepperTest, relaxed_answer_does_not_depend_on_the_settings) {
  if (leaves_hourglass_modes(choice())) return;
  Scene scene = driven_block({0.01, 0.0, 0.01});
  scene.settings.relaxation.tolerance = 1e-10;
  Observer silent;
  const NodalField once = relax(Model(scene, choice()), silent).u;
  scene.settings.relaxation.levels = 7;
  scene.settings.relaxation.check_interval = 17;
  const NodalField again = relax(Model(scene, choice()), silent).u;
  // A residual of 1e-10 allows errors of 1e-10 times the condition number of the free block, a few hundred.
  EXPECT_LT(largest_distance(once, again), 1e-7 * 0.01);
}

TEST_P(StepperTest, the_same_input_gives_the_same_bits) {
  Observer silent;
  const Scene scene = driven_block({0.04, 0.0, 0.03});
  const NodalField once = relax(Model(scene, choice()), silent).u;
  EXPECT_EQ(relax(Model(scene, choice()), silent).u, once);
  Scene dynamic = driven_block({0.04, 0.0, 0.03});
  dynamic.settings.quasi_static = false;
  dynamic.settings.dynamics.duration = 0.1;
  const Motion motion = integrate(Model(dynamic, choice()), silent);
  const Motion same = integrate(Model(dynamic, choice()), silent);
  EXPECT_EQ(motion.u, same.u);
  EXPECT_EQ(motion.v, same.v);
}

/// Every sum over nodes has a fixed order, whichever thread computes its parts: the answer has the same bits
/// for any number of threads. The block is long enough for its elements and rows to be divided.
TEST_P(StepperTest, relaxation_gives_the_same_bits_for_any_number_of_threads) {
  Scene scene = long_block();
  scene.settings.relaxation.tolerance = 1e-3;  // different bits would appear early
  Observer silent;
  for (const auto precision : {Precision::double_precision, Precision::single_precision}) {
    const Relaxation alone = relax(Model(scene, choice(precision)), silent);
    for (const int threads : {2, 4}) {
      const Relaxation shared = relax(Model(scene, choice(precision, threads)), silent);
      EXPECT_EQ(shared.steps, alone.steps);
      EXPECT_EQ(shared.u, alone.u);
    }
  }
}

/// In single precision the residual stops falling at the rounding of the forces. The run then ends and
/// reports it; the answer is as accurate as single precision permits: rounding of 6e-8 in an element's
/// forces, times its condition number K / mu = 50 and a few hundred for the block.
TEST_P(StepperTest, single_precision_ends_where_its_rounding_begins) {
  if (leaves_hourglass_modes(choice())) return;
  const Scene scene = driven_block({0.04, 0.0, 0.03});
  Observer silent;
  const Relaxation fine = relax(Model(scene, choice()), silent);
  EXPECT_TRUE(in_equilibrium(fine));
  EXPECT_EQ(outcome(fine, Precision::double_precision), "static equilibrium");
  const Relaxation coarse = relax(Model(scene, choice(Precision::single_precision)), silent);
  EXPECT_TRUE(coarse.stagnated);
  EXPECT_FALSE(coarse.converged);
  EXPECT_TRUE(in_equilibrium(coarse));
  EXPECT_TRUE(contains(outcome(coarse, Precision::single_precision), "rounding of single precision"));
  EXPECT_LT(coarse.steps, 1000);
  EXPECT_LT(largest_distance(coarse.u, fine.u), 1e-4 * largest_imposed(scene));
}

/// A tolerance below the rounding of double precision is not reached, and the run does not claim equilibrium.
TEST_P(StepperTest, stagnation_in_double_precision_is_not_called_rest) {
  Scene scene = driven_block({0.01, 0.0, 0.01});
  scene.settings.relaxation.tolerance = 1e-300;
  Observer silent;
  const Relaxation answer = relax(Model(scene, choice()), silent);
  EXPECT_TRUE(answer.stagnated);
  EXPECT_FALSE(answer.converged);
  EXPECT_FALSE(in_equilibrium(answer));
  EXPECT_TRUE(contains(outcome(answer, Precision::double_precision), "no equilibrium"));
}

/// The residual must fall below the tolerance, not just reach it. If the tolerance is the residual of an
/// answer, the search is the same, bit by bit, and must continue from there.
TEST_P(StepperTest, residual_at_the_tolerance_is_not_yet_rest) {
  Scene scene = driven_block({0.04, 0.0, 0.03});
  Observer silent;
  const Relaxation answer = relax(Model(scene, choice()), silent);
  ASSERT_TRUE(answer.converged);
  scene.settings.relaxation.tolerance = answer.residual;
  const Relaxation further = relax(Model(scene, choice()), silent);
  EXPECT_LT(further.residual, answer.residual);
  EXPECT_GT(further.steps, answer.steps);
}

TEST_P(StepperTest, step_above_the_stable_one_is_refused) {
  Scene scene = driven_block({0.0, 0.0, 0.01});
  scene.settings.quasi_static = false;
  scene.settings.dynamics.duration = 0.1;
  Observer silent;
  const StableStep stable = stable_step(Model(scene, choice()), NodalField(scene.mesh.points.size()));
  scene.settings.dynamics.time_step = 1.001 * stable.step;
  try {
    integrate(Model(scene, choice()), silent);
    FAIL() << "a step above the stable one was accepted";
  } catch (const InputError& error) {
    EXPECT_TRUE(contains(error.what(), "dynamics.time_step"));
    EXPECT_TRUE(contains(error.what(), "element " + std::to_string(stable.element)));
    EXPECT_TRUE(contains(error.what(), "made-in-a-test.toml"));
  }
  scene.settings.dynamics.time_step = 0.5 * stable.step;
  EXPECT_NO_THROW(integrate(Model(scene, choice()), silent));
}

/// Compression stiffens: a step that was stable at the start is rejected later, naming step and element. A
/// linear method does not stiffen and keeps its step.
TEST_P(StepperTest, fixed_step_is_refused_when_elements_stiffen) {
  Scene scene = driven_block({0.0, 0.0, -0.1}, 0.3);
  scene.settings.quasi_static = false;
  scene.settings.dynamics.duration = 2.0;
  const StableStep stable = stable_step(Model(scene, choice()), NodalField(scene.mesh.points.size()));
  scene.settings.dynamics.time_step = 0.999 * stable.step;
  Observer silent;
  if (method.is_linear) {
    EXPECT_EQ(integrate(Model(scene, choice()), silent).v.size(), scene.mesh.points.size());
    return;
  }
  try {
    integrate(Model(scene, choice()), silent);
    FAIL() << "a step that had become unstable was used";
  } catch (const ComputationError& error) {
    EXPECT_TRUE(contains(error.what(), "dynamics.time_step"));
    EXPECT_TRUE(contains(error.what(), "set by element"));
    EXPECT_TRUE(contains(error.what(), "at step "));
  }
  scene.settings.dynamics.time_step = 0.0;  // automatic steps follow the stiffening
  const Motion motion = integrate(Model(scene, choice()), silent);
  EXPECT_LT(motion.smallest_step, 0.9 * stable.step);
}

/// A head pushed through the foot turns elements inside out. All nodes are driven, so that there is no
/// escape: the run fails without an answer, and its message has a remedy. Steps may collapse first.
TEST_P(StepperTest, inverted_elements_end_the_run_with_a_remedy) {
  Case description = plain_case(sample_law<NeoHookean>(0.49));
  const Mesh mesh = box({0.2, 0.2, 0.1}, {2, 2, 1});
  const NodeSets sets{{"foot", nodes_where(mesh.points, [](const Vector& X) { return X[2] == 0.0; })},
                      {"head", nodes_where(mesh.points, [](const Vector& X) { return X[2] > 0.0; })}};
  description.displacements = {{"foot", {}}, {"head", {0.0, 0.0, -0.15}}};
  Scene scene = make_scene(description, mesh, sets);
  Observer silent;
  const auto expect_helpful = [](const std::string& text) {
    EXPECT_TRUE(contains(text, "step "));
    EXPECT_TRUE(contains(text, "element "));
    EXPECT_TRUE(text.find("det F") != std::string::npos || text.find("collapsed") != std::string::npos)
        << text;
    EXPECT_TRUE(contains(text, "remedy: "));
  };
  try {
    relax(Model(scene, choice()), silent);
    FAIL() << "relaxation returned an inverted body";
  } catch (const ComputationError& error) {
    expect_helpful(error.what());
  }
  scene.settings.quasi_static = false;
  scene.settings.dynamics.duration = 0.5;
  try {
    integrate(Model(scene, choice()), silent);
    FAIL() << "integration returned an inverted body";
  } catch (const ComputationError& error) {
    expect_helpful(error.what());
  }
}

TEST_P(StepperTest, an_observer_may_end_the_run) {
  Scene scene = driven_block({0.04, 0.0, 0.03});
  Recorder impatient;
  impatient.last_step = 5;
  scene.settings.relaxation.check_interval = 5;
  const Relaxation relaxation = relax(Model(scene, choice()), impatient);
  EXPECT_TRUE(relaxation.interrupted);
  EXPECT_FALSE(relaxation.converged);
  EXPECT_GE(relaxation.steps, 5);
  if (!method.pressure_varies) {  // otherwise a step takes many evaluations
    EXPECT_EQ(relaxation.steps, 5);
  }
  scene.settings.quasi_static = false;
  scene.settings.dynamics.duration = 10.0;
  const Motion motion = integrate(Model(scene, choice()), impatient);
  EXPECT_TRUE(motion.interrupted);
  EXPECT_LT(motion.time, 10.0);
}

TEST_P(StepperTest, too_few_steps_are_reported_and_not_called_equilibrium) {
  Scene scene = driven_block({0.04, 0.0, 0.03});
  scene.settings.relaxation.max_steps = 5;
  Observer silent;
  const Relaxation answer = relax(Model(scene, choice()), silent);
  EXPECT_FALSE(answer.converged);
  EXPECT_FALSE(answer.interrupted);
  EXPECT_GE(answer.steps, 5);
  if (!method.pressure_varies) {
    EXPECT_EQ(answer.steps, 5);
  }
}

// Invariance: the answer does not depend on units, position or direction.

/// A bent bar of distorted elements; `size` scales lengths, `density` and `modulus` are in the same units.
Scene bent_bar(double size, double modulus, double density, const Tensor<double>& turn, double shift) {
  Mesh mesh = box({1.0, 1.0, 3.0}, {2, 2, 6});
  const auto foot = nodes_where(mesh.points, [](const Vector& X) { return X[2] == 0.0; });
  const auto head = nodes_where(mesh.points, [](const Vector& X) { return X[2] == 3.0; });
  RandomGeometry random(23);
  for (auto& X : mesh.points) {
    for (auto& x : X) x += random.uniform(-0.06, 0.06);
    X = linear(size * turn, X);
    for (auto& x : X) x += shift;
  }
  Case description = plain_case(sample_law<NeoHookean>(0.45, modulus), density);
  description.displacements = {{"foot", {}}, {"head", linear(size * turn, {0.5, 0.2, 0.4})}};
  description.relaxation.tolerance = 1e-10;
  description.relaxation.levels = 5;  // the same path for all
  return make_scene(description, mesh, {{"foot", foot}, {"head", head}});
}

constexpr double modulus = 3000.0;
constexpr double density = 1000.0;

/// The answer of a scene: fields of displacement and velocity, and the number of steps of the motion.
struct Answers {
  std::vector<NodalField> fields;
  long steps = 0;

  /// The same with every vector mapped.
  template <class Map>
  Answers mapped(const Map& map) const {
    Answers result = *this;
    for (auto& field : result.fields) std::transform(field.begin(), field.end(), field.begin(), map);
    return result;
  }
};

/// A short motion and, if unique, the static answer: modes without energy keep roundoff there.
Answers answers(const MethodChoice& method, Scene scene) {
  Observer silent;
  Answers result;
  if (!leaves_hourglass_modes(method)) result.fields.push_back(relax(Model(scene, method), silent).u);
  scene.settings.quasi_static = false;
  scene.settings.dynamics.duration = 0.02;
  const Motion motion = integrate(Model(scene, method), silent);
  result.fields.push_back(motion.u);
  result.fields.push_back(motion.v);
  result.steps = motion.steps;
  return result;
}

/// Expects answers equal to within a fraction of the bar's size, 0.01 m; its velocities are of the order of 1
/// m/s.
void expect_equal(const Answers& a, const Answers& b, double tolerance) {
  EXPECT_EQ(a.steps, b.steps);
  ASSERT_EQ(a.fields.size(), b.fields.size());
  for (std::size_t n = 0; n < a.fields.size(); ++n) {
    EXPECT_LT(largest_distance(a.fields[n], b.fields[n]), tolerance * 0.01);
  }
}

/// Metres, kilograms and seconds against millimetres, grams and seconds, where pressures have the same values
/// and densities a millionth. An absolute length anywhere would fail.
TEST_P(StepperTest, units_do_not_matter) {
  const auto one = identity<double>();
  const auto in_si = answers(choice(), bent_bar(0.01, modulus, density, one, 0.0));
  const auto in_mm = answers(choice(), bent_bar(10.0, modulus, 1e-6 * density, one, 0.0));
  const auto in_m = in_mm.mapped([](const Vector& u) {
    return Vector{u[0] / 1000, u[1] / 1000, u[2] / 1000};
  });
  // Roundoff differs in every number and grows along the path; six digits are allowed for that.
  expect_equal(in_si, in_m, 1e-9);
}

/// A thousand lengths from the origin coordinates have three digits less: eps * 1000 per coordinate and
/// length, so gradients of u to about 1e-12, and the answer to that times the bar's condition number.
TEST_P(StepperTest, place_does_not_matter) {
  const auto one = identity<double>();
  expect_equal(answers(choice(), bent_bar(0.01, modulus, density, one, 0.0)),
               answers(choice(), bent_bar(0.01, modulus, density, one, 10.0)), 1e-8);
}

TEST_P(StepperTest, direction_does_not_matter) {
  const auto Q = RandomGeometry(29).rotation();
  const auto here = answers(choice(), bent_bar(0.01, modulus, density, identity<double>(), 0.0))
                        .mapped([&](const Vector& u) { return linear(Q, u); });
  expect_equal(here, answers(choice(), bent_bar(0.01, modulus, density, Q, 0.0)), 1e-9);
}

}  // namespace
}  // namespace sandglass::verification::stepping_test
