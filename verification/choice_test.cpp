/// The candidates of methods and meshes, and the choice.

#include <gtest/gtest.h>

#include <algorithm>
#include <map>

#include "assembly/method_entry.hpp"
#include "choice/choose.hpp"
#include "choice/longer_steps.hpp"
#include "choice/method_choices.hpp"
#include "comparison/answer.hpp"
#include "io/case_file.hpp"
#include "support/cantilever.hpp"
#include "support/scenes.hpp"
#include "support/temporary_folder.hpp"
#include "support/typed_lists.hpp"

namespace sandglass::verification::choice_test {
namespace {

Choice choose_quietly(const Case& description, const Demand& demand) {
  return choose(with_mesh(description), demand, [](double, const std::string&) { return true; });
}

/// The list has every method in both precisions, or lists it as unfit; a method whose kappa matters, with
/// other values too.
TEST(Candidates, has_every_method) {
  std::deque<CandidateMesh> meshes;
  meshes.push_back(own_mesh(cantilever(0.1)));
  const auto candidates = make_candidates(meshes, {});
  for_each_type(Methods{}, [&]<class Method>() {
    int in_double = 0, in_float = 0, unfit = 0, automatic = 0;
    for (const auto& candidate : candidates) {
      if (candidate.choice.method != Method::name) continue;
      ++(candidate.choice.precision == Precision::double_precision ? in_double : in_float);
      unfit += !candidate.unfit.empty();
      automatic += !candidate.choice.kappa;
    }
    constexpr bool without_answer = DampsOnly<typename Method::Hourglass> || zero_energy_modes<Method>() > 6;
    EXPECT_EQ(unfit, without_answer ? 1 : 0) << Method::name;
    EXPECT_EQ(in_float, without_answer ? 0 : in_double) << Method::name;
    EXPECT_GE(in_double, kappa_affects_equilibrium<Method> ? 3 : 1) << Method::name;
    EXPECT_GE(automatic, 1) << Method::name;
  });
  EXPECT_EQ(make_candidates(meshes, {.methods = {"linear"}}).size(), 6u);
}

/// An adaptive method has several candidates, with accuracies on both sides of the requested one.
TEST(Candidates, has_several_for_an_adaptive_method) {
  const auto choices = choices_of(method_named("tl-adaptive"), {"tl-adaptive"}, NeoHookean{}, 0.01);
  ASSERT_GE(choices.size(), 3u);
  EXPECT_GT(choices.front().accuracy, 0.01);
  EXPECT_LT(choices.back().accuracy, 0.01);
}

/// The order of the table: cheapest first, with a tenth added to the cost of adaptive candidates. Candidates
/// before the choice are rejected with a reason; the choice is accurate enough; more expensive candidates
/// were not tried.
TEST(Choose, takes_the_first_that_suffices) {
  const Choice choice = choose_quietly(cantilever(0.3), {.tolerance = 0.02});
  ASSERT_TRUE(choice.chosen);
  double before = 0.0;
  for (std::size_t n = 0; n < choice.attempts.size(); ++n) {
    const auto& [candidate, cost, evaluation, outcome] = choice.attempts[n];
    if (!cost) {
      EXPECT_EQ(outcome, Outcome::refused) << name_of(candidate);
      continue;
    }
    const double rank =
        (method_named(candidate.choice.method).adapts() ? 1.1 : 1.0) * *cost->per_simulated_second();
    EXPECT_GE(rank, before) << name_of(candidate);
    before = rank;
    EXPECT_GT(cost->seconds, 0.0) << name_of(candidate);
    EXPECT_EQ(cost->mean_step.has_value(), !method_named(candidate.choice.method).is_condensed);
    const auto expected = n < *choice.chosen   ? Outcome::refused
                          : n > *choice.chosen ? Outcome::not_tried
                                               : Outcome::chosen;
    EXPECT_EQ(outcome, expected) << name_of(candidate);
    EXPECT_EQ(evaluation.reason.empty(), outcome != Outcome::refused) << name_of(candidate);
    EXPECT_TRUE(outcome != Outcome::not_tried || !evaluation.error);
  }
  for (const auto& mesh : choice.others)
    EXPECT_EQ(mesh.kept, *mesh.evaluation.error <= 0.02) << mesh.evaluation.reason;
  const Evaluation& chosen = choice.attempts[*choice.chosen].evaluation;
  EXPECT_LE(*chosen.error, 0.02);
  EXPECT_GT(*chosen.smallest_jacobian, 0.0);
}

/// The prediction is the distance of the candidate's own answer from the reference's, at every node.
TEST(Choose, predicts_what_a_run_gives) {
  const Case description = cantilever(0.3);
  const Choice choice = choose_quietly(
      description, {.tolerance = 1e-4, .methods = {"tl-enhanced", "tl-perturbation"}, .all = true});
  EXPECT_FALSE(choice.chosen);
  const Scene scene = scene_of_case(description);
  Observer silent;
  const Displacements golden = compute_answer(scene, {"tl-mean-dilatation"}, silent).u;
  int compared = 0;
  for (const auto& [candidate, cost, evaluation, outcome] : choice.attempts) {
    if (!candidate.mesh->own()) continue;
    const Displacements u = compute_answer(scene, candidate.choice, silent).u;
    EXPECT_DOUBLE_EQ(*evaluation.error, largest_distance(u.front(), golden.front()) / 0.3)
        << name_of(candidate);
    ++compared;
  }
  EXPECT_EQ(compared, 2 + 6);
  for (const auto& mesh : choice.others) EXPECT_FALSE(mesh.kept);
}

/// Against the truth, a column's mesh and coarser ones are refined until the golden's element is accurate
/// enough on them. The candidates on sufficient meshes are tried; a mesh with more elements than these is
/// not.
TEST(Choose, refines_meshes_against_the_truth) {
  const auto file = std::filesystem::path(SANDGLASS_SOURCE) / "cases" / "column.toml";
  const Choice choice = choose_quietly(
      read_case_file(file), {.tolerance = 0.003, .against = "truth", .methods = {"tl-mean-dilatation"}});
  ASSERT_TRUE(choice.chosen);
  const Attempt& chosen = choice.attempts[*choice.chosen];
  EXPECT_TRUE(contains(chosen.candidate.mesh->name(), "refined to"));
  EXPECT_LE(*chosen.evaluation.error, 0.003);
  std::size_t fewest = std::numeric_limits<std::size_t>::max();
  int coarse_ones = 0;
  for (const auto& attempt : choice.others) {
    EXPECT_EQ(attempt.kept, attempt.evaluation.error && *attempt.evaluation.error <= 0.003) << attempt.mesh;
    coarse_ones += contains(attempt.mesh, "elements = ") && contains(attempt.mesh, "refined to");
  }
  EXPECT_GT(coarse_ones, 0);
  for (const auto& mesh : choice.meshes) {
    if (mesh.own()) continue;
    EXPECT_LT(mesh.scene.mesh.cells.size(), fewest) << mesh.name();
    fewest = mesh.scene.mesh.cells.size();
  }
}

/// Small strains suffice for a small motion and not for a large one, in either precision and with any kappa.
TEST(Choose, takes_small_strains_for_small_motions_only) {
  const std::vector<std::string> linear_ones{"linear", "linear-condensed"};
  const Choice small = choose_quietly(cantilever(1e-3), {.tolerance = 0.05, .methods = linear_ones});
  ASSERT_TRUE(small.chosen);
  const Choice large = choose_quietly(cantilever(0.6), {.tolerance = 0.05, .methods = linear_ones});
  EXPECT_FALSE(large.chosen);
  for (const auto& attempt : large.attempts) {
    EXPECT_TRUE(contains(attempt.evaluation.reason, "small-strain theory")) << name_of(attempt.candidate);
  }
  EXPECT_TRUE(contains(remarks(large).back(), "the most accurate candidate"));
}

/// The golden's element in double precision is the reference, bit by bit: no tolerance is too strict for it.
TEST(Choose, always_has_the_reference_itself) {
  const Choice choice = choose_quietly(cantilever(0.3), {.tolerance = 1e-15});
  ASSERT_TRUE(choice.chosen);
  const Attempt& chosen = choice.attempts[*choice.chosen];
  EXPECT_EQ(chosen.candidate.choice.method, choice.reference.name);
  EXPECT_EQ(*chosen.evaluation.error, 0.0);
}

/// No method is as fast as a picosecond; candidates over the budget are computed only if all are requested.
TEST(Choose, keeps_within_the_budget) {
  Demand demand{.tolerance = 0.05, .budget = 1e-12, .methods = {"tl-perturbation"}};
  Choice choice = choose_quietly(cantilever(0.1), demand);
  EXPECT_FALSE(choice.chosen);
  for (const auto& attempt : choice.attempts) {
    EXPECT_TRUE(contains(attempt.evaluation.reason, "a step takes"));
    EXPECT_FALSE(attempt.evaluation.error);
  }
  EXPECT_TRUE(contains(remarks(choice).back(), "too expensive"));
  demand.all = true;
  choice = choose_quietly(cantilever(0.1), demand);
  EXPECT_FALSE(choice.chosen);
  for (const auto& attempt : choice.attempts) EXPECT_TRUE(attempt.evaluation.error);
}

/// A soft body allows ten milliseconds for a step, ten thousand times what a machine needs; one with a
/// stiffness of 3e17 Pa allows a nanosecond for some 1e4 operations, which no machine achieves.
TEST(Choose, reports_what_real_time_allows) {
  Case description = cantilever(0.1);
  const Demand demand{.tolerance = 0.5, .real_time = true, .methods = {"tl-perturbation"}};
  EXPECT_TRUE(choose_quietly(description, demand).chosen);
  std::get<NeoHookean>(description.materials.front().law).young_modulus = 3e17;
  const Choice stiff = choose_quietly(description, demand);
  EXPECT_FALSE(stiff.chosen);
  for (const auto& attempt : stiff.attempts) {
    EXPECT_TRUE(contains(attempt.evaluation.reason, "not in real time"));
  }
}

/// Motions are chosen as static answers are: by the error at all times, which equals the error of a run.
/// Methods that superpose static answers are excluded; controls that resist only velocities are not.
TEST(Choose, takes_motions) {
  Case description = cantilever(0.1);
  description.quasi_static = false;
  description.dynamics = {.duration = 2.0, .ramp_time = 1.0, .frames = 5};
  const Choice choice = choose_quietly(
      description, {.tolerance = 0.1,
                    .methods = {"tl-perturbation", "tl-mean-dilatation", "linear-condensed", "ul-viscous"},
                    .all = true});
  ASSERT_TRUE(choice.chosen);
  ASSERT_EQ(choice.reference.u.size(), 5u);
  Observer silent;
  int compared = 0;
  for (const auto& [candidate, cost, evaluation, outcome] : choice.attempts) {
    if (candidate.choice.method == "linear-condensed") {
      EXPECT_TRUE(contains(evaluation.reason, "cannot compute motions"));
      continue;
    }
    EXPECT_TRUE(candidate.unfit.empty()) << name_of(candidate);
    ASSERT_TRUE(evaluation.error && evaluation.per_simulated_second)
        << name_of(candidate) << evaluation.reason;
    if (!candidate.mesh->own() || !candidate.mesh->steps.empty()) continue;
    const Displacements u = compute_answer(scene_of_case(description), candidate.choice, silent).u;
    double error = 0.0;
    for (std::size_t t = 0; t < 5; ++t)
      error = std::max(error, largest_distance(u[t], choice.reference.u[t]));
    EXPECT_DOUBLE_EQ(*evaluation.error, error / 0.1) << name_of(candidate);
    EXPECT_EQ(error == 0.0, candidate.choice.method == "tl-mean-dilatation" &&
                                candidate.choice.precision == Precision::double_precision);
    ++compared;
  }
  EXPECT_EQ(compared, 6 + 2 + 2);
}

/// Longer steps are candidates like others. All that remain are accurate enough with the golden's element.
/// The body's frequency alone lengthens the steps of a block by at least a third, softer bulk moduli lengthen
/// them further, and a stricter tolerance leaves fewer candidates.
TEST(Choose, takes_longer_steps_where_they_suffice) {
  Case description = cantilever(0.1);
  description.quasi_static = false;
  description.dynamics = {.duration = 2.0, .ramp_time = 1.0, .frames = 5};
  std::get<NeoHookean>(description.materials.front().law).poisson_ratio = 0.49;
  const auto steps_of = [&](double tolerance) {
    const Choice choice =
        choose_quietly(description, {.tolerance = tolerance, .methods = {"tl-mean-dilatation"}, .all = true});
    std::map<std::string, double> steps;
    for (const auto& [candidate, cost, evaluation, outcome] : choice.attempts) {
      if (!candidate.mesh->own() || candidate.choice.precision != Precision::double_precision) continue;
      EXPECT_LE(*evaluation.error, tolerance) << candidate.mesh->name();
      steps[candidate.mesh->steps] = *cost->mean_step;
    }
    return steps;
  };
  const std::string body = "body_frequency";
  const auto steps = steps_of(0.05);
  ASSERT_TRUE(steps.contains(body + ", bulk / 2.5"));
  EXPECT_GT(steps.at(body), 1.33 * steps.at(""));
  EXPECT_GT(steps.at(body + ", bulk / 2.5"), 1.4 * steps.at(body));
  EXPECT_LT(steps_of(1e-5).size(), steps.size());
}

/// Softer moduli keep what the frequency of a beam depends on: E changes by a root only, and the distance of
/// Poisson's ratio from 1/2 grows by the factor. A law without these parameters gets only the body's steps.
TEST(LongerSteps, soften_what_can_be_softened) {
  Case description = cantilever(0.1);
  description.quasi_static = false;
  description.materials.front().law = NeoHookean{.young_modulus = 3000.0, .poisson_ratio = 0.49};
  const auto longer = longer_steps(with_mesh(description));
  ASSERT_EQ(longer.size(), 5u);
  for (const auto& [difference, steps] : longer) EXPECT_EQ(steps.description.dynamics.body_frequency, 1);
  const auto& law = std::get<NeoHookean>(longer[3].problem.description.materials.front().law);
  EXPECT_NEAR(law.poisson_ratio, 0.45, 1e-15);
  EXPECT_NEAR(law.young_modulus, 3000.0 * std::sqrt(1.49 / 1.45), 1e-9);
  description.dynamics.body_frequency = 1;
  EXPECT_EQ(longer_steps(with_mesh(description)).size(), 4u);  // it already has the body's steps
  description.dynamics.body_frequency = 0;
  description.materials.front().law = Ogden{.mu1 = 800.0, .alpha1 = 3.0, .K = 5e4};
  EXPECT_EQ(longer_steps(with_mesh(description)).size(), 1u);
  description.dynamics.subcycles = 2;
  EXPECT_TRUE(longer_steps(with_mesh(description)).empty());
}

TEST(Choose, refuses_what_it_cannot_do) {
  const auto unknown = [] { choose_quietly(cantilever(0.1), {.methods = {"tl-perturbatio"}}); };
  EXPECT_TRUE(contains(input_error(unknown), "did you mean 'tl-perturbation'"));
  const auto without = [] { choose_quietly(cantilever(0.1), {.against = "truth"}); };
  EXPECT_FALSE(input_error(without).empty());
  const auto stop = [](double, const std::string&) { return false; };
  EXPECT_THROW(choose(with_mesh(cantilever(0.1)), {}, stop), ComputationError);
}

}  // namespace
}  // namespace sandglass::verification::choice_test
