/// Loads that follow formulas of time. Python's tests read the same list of formulas.

#include "forces/formula.hpp"

#include <gtest/gtest.h>

#include "io/case_file.hpp"
#include "io/toml.hpp"
#include "solve/central_difference.hpp"
#include "support/case_text.hpp"
#include "support/scenes.hpp"
#include "support/temporary_folder.hpp"

namespace sandglass::verification::formula_test {
namespace {

toml::table formulas() {
  return toml::parse_file(SANDGLASS_SOURCE "/verification/formulas.toml");
}

/// A box under its weight, constant or following the curve that `keys` define.
Case hanging(const TemporaryFolder& folder, const std::string& keys) {
  const std::string base = box_case("hanging", "[1.0, 1.0, 2.0]", "[1, 1, 2]") + R"(
[sets]
foot = { z = [0.0, 0.0] }

[[displacement]]
set = "foot"
value = [0.0, 0.0, 0.0]

[[gravity]]
value = [0.0, 0.0, -9.81]
)";
  return read_case_file(folder.write("hanging.toml", base + keys));
}

/// A few roundings of numbers near one.
TEST(Formula, values_are_those_of_40_digits) {
  const toml::table known = formulas();
  const toml::array& times = *known["times"].as_array();
  for (const auto& node : *known["good"].as_array()) {
    const toml::table& one = *node.as_table();
    const auto text = *one["formula"].value<std::string>();
    const auto value_at = parse_formula(text);
    for (std::size_t k = 0; k < times.size(); ++k) {
      const double exact = *one["values"][k].value<double>();
      EXPECT_NEAR(value_at(*times[k].value<double>()), exact, 1e-15 * std::max(1.0, std::abs(exact))) << text;
    }
  }
}

TEST(Formula, mistakes_are_named_with_their_position) {
  const TemporaryFolder folder;
  const toml::table known = formulas();
  for (const auto& node : *known["wrong"].as_array()) {
    const toml::table& one = *node.as_table();
    const auto text = *one["formula"].value<std::string>();
    const auto position = *one["position"].value<int>();
    const std::string said = input_error([&] { hanging(folder, "formula = \"" + text + "\"\n"); });
    EXPECT_NE(said.find("hanging.toml:"), std::string::npos) << said;
    EXPECT_NE(said.find("gravity.formula"), std::string::npos) << said;
    EXPECT_NE(said.find(*one["named"].value<std::string>()), std::string::npos) << said;
    if (position == 0) continue;
    EXPECT_NE(said.find(fmt::format("at position {};", position)), std::string::npos) << said;
  }
  EXPECT_NE(input_error([&] {
              hanging(folder, "formula = \"t\"\ntimes = [0.0]\nfactors = [0.0]\n");
            }).find("a formula or a table, not both"),
            std::string::npos);
  const auto until_one = parse_formula("sqrt(1 - t)");
  EXPECT_EQ(until_one(0.75), 0.5);
  EXPECT_EQ(input_error([&] { until_one(1.5); }),
            "formula = 'sqrt(1 - t)' is not a number at t = 1.5; it must be finite");
}

// A formula can be wrong later than at the start, when the reader of the file is gone.
TEST(Formula, values_that_are_not_finite_are_named_with_their_place_in_the_file) {
  const TemporaryFolder folder;
  for (const auto& [text, is] :
       {std::pair("1 / (t - 0.5)", "infinite"), std::pair("log(0.4 - t)", "not a number")}) {
    const Case description = hanging(folder, fmt::format("formula = \"{}\"\n", text));
    const std::string said = input_error([&] { description.forces.of<Gravity>()[0].curve.at(0.5, 0.0); });
    EXPECT_NE(said.find("hanging.toml:"), std::string::npos) << said;
    const std::string rule =
        fmt::format("gravity.formula = '{}' is {} at t = 0.5; it must be finite", text, is);
    EXPECT_NE(said.find(rule), std::string::npos) << said;
  }
}

TEST(Formula, is_a_curve_like_a_table) {
  const TemporaryFolder folder;
  const auto curve = [&](const std::string& keys) {
    return hanging(folder, keys).forces.of<Gravity>()[0].curve;
  };
  const LoadCurve formula = curve("formula = \"1 - 3*min(t, 0.5)\"\n");
  const LoadCurve table = curve("times = [0.0, 0.5]\nfactors = [1.0, -0.5]\n");
  for (const double t : {0.0, 0.1, 0.5, 2.0}) EXPECT_DOUBLE_EQ(formula.at(t, 0.3), table.at(t, 0.3)) << t;
  EXPECT_EQ(formula.largest(1.0), table.largest(1.0));
  EXPECT_EQ(curve("formula = \"-7*t\"\n").largest(0.5), 3.5);
  EXPECT_EQ(curve("").largest(0.5), 1.0);
  EXPECT_TRUE(formula == curve("formula = \"1 - 3*min(t, 0.5)\"\n"));
  EXPECT_FALSE(formula == curve("formula = \"1 - 3*t\"\n"));
  const std::string hash = case_hash(hanging(folder, "formula = \"t\"\n"));
  EXPECT_NE(hash, case_hash(hanging(folder, "formula = \"t^2\"\n")));
  EXPECT_NE(hash, case_hash(hanging(folder, "")));
}

/// A free body under the weight g cos(w t), which starts at rest, is at (g / w^2) (1 - cos w t); with central
/// differences of step h, w^2 becomes (2 / h sin(w h / 2))^2, exactly.
TEST(Formula, shakes_a_free_body) {
  const double g = 9.81, w = 40.0, h = 1e-3;
  Case description = plain_case(NeoHookean{.young_modulus = 3000.0, .poisson_ratio = 0.45});
  description.quasi_static = false;
  description.forces.of<Gravity>() = {{{0.0, 0.0, -g}, {.formula = Formula("cos(40*t)")}}};
  description.dynamics = {.duration = 0.1, .time_step = h};
  Recorder recorder;
  const Scene scene = make_scene(description, box({0.1, 0.1, 0.2}, {2, 2, 4}), {});
  const Motion motion = integrate(Model(scene, {"tl-mean-dilatation"}), recorder);
  const double of_steps = 2.0 / h * std::sin(w * h / 2.0);
  const double exact = -g / (of_steps * of_steps) * (1.0 - std::cos(w * 0.1));
  for (const Vector& u : motion.u) EXPECT_NEAR(u[2], exact, 1e-12);
}

}  // namespace
}  // namespace sandglass::verification::formula_test
