/// Comparison with references: figures, limits, and the column against its golden.

#include <gtest/gtest.h>

#include "assembly/method_entry.hpp"
#include "comparison/verdict_json.hpp"
#include "io/case_file.hpp"
#include "support/scenes.hpp"
#include "support/temporary_folder.hpp"

namespace sandglass::verification::comparison_test {
namespace {

TEST(Accuracy, of_equal_fields_is_zero) {
  const NodalField u{{1, 2, 3}, {4, 5, 6}};
  const std::vector<int> profile{1};
  const Accuracy figures = accuracy(u, u, &profile, 0.5);
  EXPECT_EQ(figures.max_relative_error, 0.0);
  EXPECT_EQ(figures.profile_relative_error, 0.0);
  EXPECT_EQ(figures.rms_relative_error, 0.0);
}

TEST(Accuracy, figures_of_a_field_made_by_hand) {
  // Distances 5, 0, 13, 0: unequal in all components, and the largest is not on the profile.
  const NodalField reference{{1, 1, 1}, {2, 2, 2}, {0, 0, 0}, {7, 7, 7}};
  const NodalField u{{1, 4, 5}, {2, 2, 2}, {3, 4, 12}, {7, 7, 7}};
  const std::vector<int> profile{0, 1};
  const Accuracy figures = accuracy(u, reference, &profile, 2.0);
  EXPECT_DOUBLE_EQ(figures.max_relative_error, 6.5);
  EXPECT_DOUBLE_EQ(*figures.profile_relative_error, 2.5);
  EXPECT_DOUBLE_EQ(figures.rms_relative_error, std::sqrt((25.0 + 169.0) / 4) / 2);
  EXPECT_FALSE(accuracy(u, reference, nullptr, 2.0).profile_relative_error.has_value());
}

/// Over time, every figure is its largest value at any time, and the worst time is that of the largest
/// distance.
TEST(Accuracy, over_time_is_the_worst) {
  const Displacements reference(3, NodalField(4));
  Displacements u = reference;
  u[1] = NodalField(4, Vector{0.0, 0.0, 3.0});
  u[2][3] = {0.0, 4.0, 0.0};
  const std::vector<int> profile{0};
  const Accuracy figures = accuracy(u, reference, &profile, 2.0);
  EXPECT_EQ(figures.max_relative_error, 2.0);
  EXPECT_EQ(figures.rms_relative_error, 1.5);
  EXPECT_EQ(figures.profile_relative_error, 1.5);
  EXPECT_EQ(worst_time(u, reference), 2u);
}

/// A verdict of the case "test" with one figure against the golden.
Verdict verdict(const std::string& method, std::optional<double> kappa, bool automatic, double figure,
                const std::string& status = "ok") {
  Verdict v{
      .case_name = "test", .method = method, .kappa = kappa, .kappa_is_auto = automatic, .status = status};
  v.golden = Accuracy{figure, figure / 2, figure / 4};
  return v;
}

class LimitTest : public ::testing::Test {
 protected:
  /// The outcome of one expectation.
  LimitCheck check(const Expectation& expected, const std::vector<Verdict>& verdicts) {
    return check_limits("test", {expected}, verdicts).at(0);
  }

  static Expectation below(const std::string& method, const std::string& kappa, double limit) {
    return {method, kappa, "golden", "max_relative_error", limit, {}, "a test"};
  }
  static Expectation above(const std::string& method, double limit) {
    return {method, "auto", "golden", "max_relative_error", {}, limit, "a test"};
  }

  std::vector<Verdict> curve{
      verdict("tl-perturbation", 0.0065, true, 0.03), verdict("tl-perturbation", 0.005, false, 0.02),
      verdict("tl-perturbation", 0.05, false, 0.2), verdict("tl-none", {}, false, 0.4)};
};

TEST_F(LimitTest, upper_limit_holds_or_breaks) {
  EXPECT_TRUE(check(below("tl-perturbation", "auto", 0.031), curve).holds);
  EXPECT_FALSE(check(below("tl-perturbation", "auto", 0.029), curve).holds);
  EXPECT_EQ(check(below("tl-perturbation", "auto", 0.029), curve).figure, 0.03);
}

TEST_F(LimitTest, kappa_selects_the_run) {
  EXPECT_EQ(check(below("tl-perturbation", "0.05", 1.0), curve).figure, 0.2);
  const auto best = check(below("tl-perturbation", "best", 1.0), curve);
  EXPECT_EQ(best.figure, 0.02);
  EXPECT_EQ(best.kappa, 0.005);
}

TEST_F(LimitTest, figure_and_reference_are_the_ones_asked_for) {
  auto expected = below("tl-none", "auto", 1.0);
  expected.figure = "profile_relative_error";
  EXPECT_EQ(check(expected, curve).figure, 0.2);
  expected.figure = "rms_relative_error";
  EXPECT_EQ(check(expected, curve).figure, 0.1);
  expected.reference = "truth";
  EXPECT_FALSE(check(expected, curve).holds);  // no such verdict
}

TEST_F(LimitTest, limits_are_for_double) {
  for (auto& v : curve) v.precision = "float";
  EXPECT_FALSE(check(below("tl-perturbation", "auto", 1.0), curve).figure);
}

TEST_F(LimitTest, method_that_must_fail_is_caught_when_it_does_not) {
  EXPECT_TRUE(check(above("tl-none", 0.05), curve).holds);
  EXPECT_FALSE(check(above("tl-none", 0.5), curve).holds);
}

TEST_F(LimitTest, missing_figures_break_limits) {
  EXPECT_FALSE(check(below("tl-full", "auto", 1.0), curve).holds);
  EXPECT_FALSE(check(above("tl-full", 0.0), curve).holds);
}

/// A run that did not reach equilibrium may prove that a method fails, never that it is accurate.
TEST_F(LimitTest, unfinished_run_proves_no_accuracy) {
  const std::vector<Verdict> unfinished{verdict("tl-full", {}, false, 0.01, "failed: not at rest")};
  EXPECT_FALSE(check(below("tl-full", "auto", 0.1), unfinished).holds);
  EXPECT_TRUE(check(above("tl-full", 0.001), unfinished).holds);
}

TEST(Verdict, json_has_every_figure_and_null_for_what_is_not_there) {
  const std::string text = to_json({{"revision", "abc"}}, {verdict("tl-none", {}, false, 0.5)}, {});
  for (const char* part : {"\"revision\": \"abc\"",
                           "\"case\": \"test\"",
                           "\"method\": \"tl-none\"",
                           "\"kappa\": null",
                           "\"precision\": \"double\"",
                           "\"status\": \"ok\"",
                           "\"max_relative_error\": 0.5",
                           "\"truth\": null",
                           "\"profile_relative_error\": 0.25",
                           "\"rms_relative_error\": 0.125",
                           "\"residual\"",
                           "\"hourglass_energy_ratio\"",
                           "\"ns_per_element_step\": null",
                           "\"mean_step_seconds\": null",
                           "\"seconds_per_simulated_second\": null",
                           "\"equilibrium_seconds\": null",
                           "\"evaluations\": null",
                           "\"motion_seconds\": null",
                           "\"steps\": null",
                           "\"load_in_steps\": null"}) {
    EXPECT_TRUE(contains(text, part)) << part;
  }
}

/// The costs of a step, a simulated second, a static solution and a motion are separate: none replaces
/// another.
TEST(Verdict, json_names_each_kind_of_cost) {
  Verdict v = verdict("tl-none", {}, false, 0.5);
  v.elements = 1000;
  v.search = SearchCost{.seconds = 3.0, .evaluations = 16};
  v.step_cost = StepCost{
      .seconds = 2e-5, .lower_quartile = 1e-5, .upper_quartile = 4e-5, .checks = 2e-6, .mean_step = 5e-4};
  const std::string text = to_json({}, {v}, {});
  for (const char* part :
       {"\"ns_per_element_step\": 20.0", "\"ns_lower_quartile\": 10.0", "\"ns_upper_quartile\": 40.0",
        "\"mean_step_seconds\": 0.0005", "\"check_ns_per_element_step\": 2.0",
        "\"seconds_per_simulated_second\": 0.044", "\"equilibrium_seconds\": 3.0", "\"evaluations\": 16",
        "\"steps\": null", "\"motion_seconds\": null"}) {
    EXPECT_TRUE(contains(text, part)) << part << text;
  }
  v.search.reset();
  v.motion = MotionCost{.seconds = 7.0, .steps = 21};
  v.step_cost->condensed = true;  // an answer is no step
  const std::string moving = to_json({}, {v}, {});
  for (const char* part : {"\"ns_per_element_step\": null", "\"seconds_per_simulated_second\": 0.02",
                           "\"equilibrium_seconds\": null", "\"evaluations\": null", "\"steps\": 21",
                           "\"motion_seconds\": 7.0"}) {
    EXPECT_TRUE(contains(moving, part)) << part << moving;
  }
}

/// An inversion sets the status of the verdict; it does not end the program.
TEST(Verdict, failed_computation_becomes_a_status) {
  Case description = plain_case(sample_law<NeoHookean>(0.49));
  const Mesh mesh = box({0.1, 0.1, 0.1}, {1, 1, 1});
  const NodeSets sets{{"foot", nodes_where(mesh.points, [](const Vector& X) { return X[2] == 0.0; })},
                      {"head", nodes_where(mesh.points, [](const Vector& X) { return X[2] > 0.0; })}};
  description.displacements = {{"foot", {}}, {"head", {0.0, 0.0, -0.15}}};
  const Scene scene = make_scene(description, mesh, sets);
  for (const auto& method : names_of(Methods{})) {
    Displacements u;
    const Verdict v = run_and_compare(scene, {}, {method, {}}, u);
    EXPECT_FALSE(v.ok());
    EXPECT_TRUE(contains(v.status, "failed: step "));
    EXPECT_FALSE(v.golden.has_value());
    EXPECT_TRUE(u.empty());
  }
}

/// The column of the paper against the golden of another program (FEniCSx, Q1-P0). Mean dilatation solves the
/// same problem: two solvers that stop at residuals of 1e-8 and below agree to 1e-6. Without control the
/// column must hourglass visibly, as in the paper's figure 3(b).
TEST(Golden, column) {
  const Scene scene = read_scene(std::filesystem::path(SANDGLASS_SOURCE) / "cases" / "column.toml");
  const References references = read_references(scene);
  ASSERT_TRUE(references.golden.has_value());
  Displacements u;
  const Verdict same = run_and_compare(scene, references, {"tl-mean-dilatation", {}}, u);
  ASSERT_TRUE(same.ok()) << same.status;
  EXPECT_LT(same.golden->max_relative_error, 1e-6);
  const Verdict controlled = run_and_compare(scene, references, {"tl-perturbation", {}}, u);
  ASSERT_TRUE(controlled.ok()) << controlled.status;
  EXPECT_LT(controlled.golden->max_relative_error, 0.002);  // the case's own limit
  const auto automatic = [&](KappaModulus modulus) {
    return method_named("tl-perturbation")
        .auto_kappa(elastic_law(kernel_law(scene.materials.list.front().law)), modulus);
  };
  EXPECT_EQ(controlled.kappa, automatic(KappaModulus::p_wave));
  const MethodChoice by_shear{.method = "tl-perturbation", .kappa_modulus = KappaModulus::shear};
  EXPECT_EQ(run_and_compare(scene, references, by_shear, u).kappa, automatic(KappaModulus::shear));
  const Verdict uncontrolled = run_and_compare(scene, references, {"tl-none", {}}, u);
  EXPECT_GT(uncontrolled.golden->max_relative_error, 0.05);
}

}  // namespace
}  // namespace sandglass::verification::comparison_test
