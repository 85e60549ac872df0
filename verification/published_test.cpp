/// Published values: comparison, limits, tables and JSON.

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <numbers>

#include "comparison/published_table.hpp"
#include "comparison/verdict_json.hpp"
#include "support/random_hexahedra.hpp"
#include "support/scenes.hpp"
#include "support/temporary_folder.hpp"

namespace sandglass::verification::published_test {
namespace {

/// A block whose upper face is a set.
Scene block() {
  Case description = plain_case(sample_law<NeoHookean>(0.3));
  const Mesh mesh = box({1.0, 2.0, 3.0}, {2, 3, 1});
  const NodeSets sets{{"top", nodes_where(mesh.points, [](const Vector& X) { return X[2] == 3.0; })}};
  return make_scene(description, mesh, sets);
}

PublishedValue value_of(const std::string& component, double value = 1.0) {
  return {"top", component, value, "a book"};
}

/// For any a, u = a + b x X has the rotation b about any axis, and the mean a + b x (middle of the face).
TEST(Published, mean_and_rotation_of_a_rigid_motion) {
  const Scene scene = block();
  const Vector a{0.3, -0.1, 0.2}, b{1e-3, -2e-3, 3e-3};
  NodalField u;
  for (const auto& X : scene.mesh.points) {
    u.push_back({a[0] + b[1] * X[2] - b[2] * X[1], a[1] + b[2] * X[0] - b[0] * X[2],
                 a[2] + b[0] * X[1] - b[1] * X[0]});
  }
  const Vector mean{a[0] + b[1] * 3.0 - b[2] * 1.0, a[1] + b[2] * 0.5 - b[0] * 3.0,
                    a[2] + b[0] * 1.0 - b[1] * 0.5};
  for (std::size_t i = 0; i < 3; ++i) {
    const std::string axis(1, "xyz"[i]);
    EXPECT_NEAR(motion_of(scene, u, value_of(axis)), mean[i], 1e-15);
    EXPECT_NEAR(motion_of(scene, u, value_of("around-" + axis)), b[i], 1e-15);
  }
}

/// Stretch and shear without rotation give no rotation: on a square face the shear's two halves cancel.
TEST(Published, pure_strain_is_no_rotation) {
  Case description = plain_case(sample_law<NeoHookean>(0.3));
  const Mesh mesh = box({1.0, 1.0, 1.0}, {2, 2, 2});
  const NodeSets sets{{"top", nodes_where(mesh.points, [](const Vector& X) { return X[2] == 1.0; })}};
  const Scene scene = make_scene(description, mesh, sets);
  const Tensor<double> strain{{0.01, 0.02, 0, 0.02, -0.03, 0, 0, 0, 0.04}};
  NodalField u;
  for (const auto& X : mesh.points) u.push_back(linear(strain, X));
  EXPECT_NEAR(motion_of(scene, u, value_of("around-z")), 0.0, 1e-16);
}

/// A point off the upper face moves as the face does in any linear motion: extrapolation within its plane is
/// exact. A point above the plane has no motion that its nodes define.
TEST(Published, a_point_moves_with_its_set) {
  const Scene scene = block();
  const Tensor<double> gradient{{0.1, 0.2, -0.3, 0.4, -0.5, 0.6, 0.7, 0.8, -0.9}};
  NodalField u;
  for (const auto& X : scene.mesh.points) u.push_back(linear(gradient, X));
  PublishedValue published = value_of("y");
  published.at = Vector{-1.5, 2.5, 3.0};
  EXPECT_NEAR(motion_of(scene, u, published), linear(gradient, *published.at)[1], 1e-14);
  EXPECT_FALSE(point_weights(scene.mesh.points, scene.sets.at("top"), {0.0, 0.0, 3.1}).has_value());
}

/// A sampled cosine has its peak and its period where a parabola through three samples has them: the cosine's
/// fourth derivative moves them by (omega dt)^2 / 24 of a step, here 1e-4 of a period.
TEST(Published, peaks_and_periods_of_a_motion) {
  Scene scene = block();
  scene.settings.quasi_static = false;
  scene.settings.dynamics = {.duration = 2.0, .frames = 40};
  const double omega = 7.0, dt = 0.05;
  Displacements u;
  for (int k = 1; k <= 40; ++k)
    u.emplace_back(scene.mesh.points.size(), Vector{0.0, 0.0, -0.3 * (1.0 - std::cos(omega * dt * k))});
  PublishedValue published = value_of("z");
  published.of = Feature::peak;
  EXPECT_NEAR(*computed_value(scene, u, published), -0.6, 1e-3 * 0.6);
  published.of = Feature::period;
  EXPECT_NEAR(*computed_value(scene, u, published), 2.0 * std::numbers::pi / omega, 3e-3);
  u.resize(20);  // one peak
  EXPECT_FALSE(computed_value(scene, u, published).has_value());
  published.of = Feature::end;
  EXPECT_DOUBLE_EQ(*computed_value(scene, u, published), u.back()[0][2]);
}

/// Errors of measured values, of their periods and of published values are separate figures.
TEST(Published, measured_values_have_figures_of_their_own) {
  PublishedResult computed{value_of("x"), 1.1, {}, {}}, measured{value_of("x"), 1.2, {}, {}};
  measured.published.scatter = 0.1;
  PublishedResult period = measured;
  period.published.of = Feature::period;
  period.computed = 1.3;
  const std::vector<PublishedResult> all{computed, measured, period};
  EXPECT_DOUBLE_EQ(*largest_relative_error(all), 1.1 - 1.0);
  EXPECT_DOUBLE_EQ(*largest_relative_error(all, true), 1.2 - 1.0);
  EXPECT_DOUBLE_EQ(*largest_relative_error(all, true, true), 1.3 - 1.0);
}

/// Results of a scene with two published values whose nodes all move by `move`.
std::vector<PublishedResult> results(const Vector& move) {
  const Scene scene = block();
  const NodalField u(scene.mesh.points.size(), move), truth(u.size(), Vector{0.4, 0.0, -0.125});
  auto found = published_results(scene, {value_of("x", 0.5), value_of("z", -0.2)}, Displacements{truth}, {});
  EXPECT_FALSE(largest_relative_error(found).has_value());
  fill_computed(scene, {u}, {}, found);
  return found;
}

/// Forces are those of the reactions, not of displacements, and references have none.
TEST(Published, forces_of_obstacles_add_up) {
  PublishedValue weight = value_of("z", 8.0);
  weight.obstacles = {"left", "right"};
  const Scene scene = block();
  const Displacements u{NodalField(scene.mesh.points.size(), Vector{1.0, 1.0, 1.0})};
  auto found = published_results(scene, {weight}, u, u);
  fill_computed(scene, u, {}, found);
  EXPECT_FALSE(found[0].truth || found[0].golden || found[0].computed);
  const Reactions last{{"left", {1, 0, 3}}, {"right", {-1, 0, 4}}, {"table", {0, 0, 9}}};
  fill_computed(scene, u, {{0.0, {}}, {1.0, last}}, found);
  EXPECT_EQ(found[0].computed, 7.0);
}

/// A mean over time counts each force for the time since the check before.
TEST(Published, mean_force_at_the_end) {
  PublishedValue weight = value_of("x");
  weight.obstacles = {"jaw"};
  const auto at_time = [](double time, double force) {
    return ReactionsAt{time, {{"jaw", {force, 0.0, 0.0}}}};
  };
  const std::vector<ReactionsAt> checks{at_time(0, 90), at_time(1, 80), at_time(3, 5), at_time(4, 8)};
  EXPECT_EQ(force_of(checks, weight), 8.0);
  weight.over = 3.0;
  EXPECT_EQ(force_of(checks, weight), (2.0 * 5.0 + 8.0) / 3.0);
  weight.over = 4.0;
  EXPECT_EQ(force_of(checks, weight), (80.0 + 2.0 * 5.0 + 8.0) / 4.0);
}

TEST(Published, ratios_and_the_largest_error) {
  const auto found = results({0.45, 7.0, -0.25});
  ASSERT_EQ(found.size(), 2U);
  EXPECT_DOUBLE_EQ(*found[0].ratio(), 0.9);
  EXPECT_DOUBLE_EQ(*found[1].ratio(), 1.25);
  EXPECT_DOUBLE_EQ(*found[0].ratio_to_truth(), 1.125);
  EXPECT_DOUBLE_EQ(*found[1].ratio_to_truth(), 2.0);
  EXPECT_DOUBLE_EQ(*largest_relative_error(found), 0.25);
}

/// A verdict of a variant, with the results above.
Verdict verdict(const std::string& method, const std::string& variant, const Vector& move,
                const std::string& status = "ok") {
  Verdict v{.case_name = "bar-" + variant, .method = method, .status = status};
  v.family = "bar";
  v.variants = {variant};
  v.published = results(move);
  return v;
}

TEST(Published, limits_hold_or_break) {
  const auto check = [&](std::optional<double> below, std::optional<double> above, const Verdict& v) {
    const Expectation expected{"tl-full", "auto", "published", "relative_error", below, above, "a test"};
    return check_limits("bar-1", {expected}, {v}).at(0).holds;
  };
  const Verdict near = verdict("tl-full", "1", {0.45, 0.0, -0.22});  // off by a tenth in both
  EXPECT_TRUE(check(0.11, {}, near));
  EXPECT_FALSE(check(0.09, {}, near));
  EXPECT_TRUE(check({}, 0.09, near));
  EXPECT_FALSE(check({}, 0.11, near));
  Verdict failed = verdict("tl-full", "1", {0.45, 0.0, -0.22}, "failed: not at rest");
  EXPECT_FALSE(check(0.11, {}, failed));
}

/// Rows are methods, columns the variants with each of their values; a failed run has no number, and a
/// verdict without published values no row.
TEST(Published, tables_have_a_row_for_each_method_and_a_column_for_each_value) {
  const std::string text = published_tables({verdict("tl-none", "1", {0.45, 0, -0.25}),
                                             verdict("tl-full", "1", {0.5, 0, 25.0}),
                                             verdict("tl-none", "2", {0.1, 0, -0.1}, "failed: why"),
                                             verdict("tl-full", "2", {0.1, 0, -0.1}),
                                             {.case_name = "other", .method = "ul-full", .status = "ok"}});
  EXPECT_TRUE(contains(text, "bar: computed over published (a book)"));
  EXPECT_TRUE(contains(text, "bar: computed over truth"));
  const auto row = [&](const std::string& name, const std::string& after) {
    std::istringstream stream(text.substr(text.find(name, text.find(after))));
    std::string line;
    std::getline(stream, line);
    std::istringstream words(line);
    return std::vector<std::string>(std::istream_iterator<std::string>(words), {});
  };
  using Words = std::vector<std::string>;
  EXPECT_EQ(row("tl-none", "published"), (Words{"tl-none", "0.9000", "1.2500", "failed", "failed"}));
  EXPECT_EQ(row("tl-full", "published"), (Words{"tl-full", "1.0000", "-1.2e+02", "0.2000", "0.5000"}));
  EXPECT_EQ(row("tl-none", "over truth"), (Words{"tl-none", "1.1250", "2.0000", "failed", "failed"}));
  EXPECT_EQ(text.find("ul-full"), std::string::npos);
}

/// A verdict of a beam with 4 elements and known results of two other programs.
Verdict beside_programs(const std::string& method, const std::string& elements, const Vector& move) {
  Verdict v = verdict(method, "thin", move);
  v.variants.push_back(elements);
  v.published[1].published.programs = {{"Other, Q1", {2, 16}, {-0.15, -0.19}, "their manual"},
                                       {"Third", {}, {-0.2001}, "a thesis"}};
  return v;
}

/// A column for each mesh that anyone has, in the order of the numbers of elements; there is no such table
/// for values without programs.
TEST(Published, values_of_other_programs_stand_in_rows_below_ours) {
  const std::string text = published_tables(
      {beside_programs("tl-full", "16", {0.5, 0, -0.18}), beside_programs("tl-full", "4", {0.5, 0, -0.17})});
  const std::string title = "bar thin: z of top, published -0.2 (a book)\n";
  ASSERT_TRUE(contains(text, title));
  EXPECT_FALSE(contains(text, "x of top"));
  std::istringstream lines(text.substr(text.find(title) + title.size()));
  const auto words = [&] {
    std::string line;
    std::getline(lines, line);
    std::istringstream stream(line);
    return std::vector<std::string>(std::istream_iterator<std::string>(stream), {});
  };
  using Words = std::vector<std::string>;
  EXPECT_EQ(words(), (Words{"2", "4", "16", "other"}));
  EXPECT_EQ(words(), (Words{"tl-full", "-0.17", "-0.18"}));
  EXPECT_EQ(words(), (Words{"Other,", "Q1", "-0.15", "-0.19"}));
  EXPECT_EQ(words(), (Words{"Third", "-0.2001"}));
  EXPECT_EQ(words(), (Words{"Other,", "Q1:", "their", "manual"}));
}

TEST(Published, json_has_every_value_of_other_programs) {
  const std::string text = to_json({}, {beside_programs("tl-full", "4", {0.5, 0, -0.17})}, {});
  const auto document = nlohmann::json::parse(text);
  const auto& values = document["published"][0]["values"];
  EXPECT_EQ(values[0]["programs"], nlohmann::json::array());
  const auto& first = values[1]["programs"][0];
  EXPECT_EQ(first["program"], "Other, Q1");
  EXPECT_EQ(first["elements"], (std::vector<int>{2, 16}));
  EXPECT_EQ(first["values"], (std::vector<double>{-0.15, -0.19}));
  EXPECT_EQ(first["source"], "their manual");
  EXPECT_EQ(values[1]["programs"][1]["elements"], nlohmann::json::array());
}

TEST(Published, json_keeps_such_runs_apart_with_every_value) {
  const std::string text = to_json({}, {verdict("tl-full", "1", {0.45, 0, -0.25})}, {});
  for (const char* part :
       {"\"records\": []", "\"case\": \"bar-1\"", "\"family\": \"bar\"", "\"source\": \"a book\"",
        "\"component\": \"z\"", "\"published\": -0.2", "\"computed\": -0.25", "\"ratio\": 1.25",
        "\"truth\": -0.125", "\"ratio_to_truth\": 2.0"}) {
    EXPECT_TRUE(contains(text, part));
  }
}

}  // namespace
}  // namespace sandglass::verification::published_test
