#include "comparison/comparison.hpp"

#include <fmt/ranges.h>

#include <algorithm>
#include <map>

#include "assembly/method_entry.hpp"
#include "base/error.hpp"
#include "base/names.hpp"
#include "comparison/published.hpp"
#include "forces/contact_force.hpp"
#include "io/case_file.hpp"
#include "io/case_variants.hpp"
#include "io/table_reader.hpp"

namespace sandglass {

namespace {

namespace fs = std::filesystem;

/// Along an axis, or around it.
std::vector<std::string> directions() {
  return {"x", "y", "z", "around-x", "around-y", "around-z"};
}

ProgramValues read_program(TableReader table) {
  ProgramValues found;
  found.program = table.required<std::string>("program");
  found.values = table.required<std::vector<double>>("values", Range::any());
  if (const auto elements = table.optional<std::vector<int>>("elements", Range::at_least(1)))
    found.elements = *elements;
  const std::size_t expected = found.elements.empty() ? 1 : found.elements.size();
  if (found.values.size() != expected) {
    table.fail("values", fmt::format("has {} numbers; {} expected, one for each of `elements`, or one alone",
                                     found.values.size(), expected));
  }
  found.source = table.required<std::string>("source");
  table.finish();
  return found;
}

PublishedValue read_published(TableReader table, bool measured) {
  PublishedValue published;
  if (const auto obstacles = table.optional<std::vector<std::string>>("obstacles")) {
    published.obstacles = *obstacles;
    published.set = fmt::to_string(fmt::join(*obstacles, " + "));
    published.over = table.optional<double>("over", Range::at_least(0.0)).value_or(0.0);
    if (table.optional<std::string>("set"))
      table.fail("obstacles", "was given with set; allowed: a force of obstacles, or a motion of a set");
  } else {
    published.set = table.required<std::string>("set");
  }
  published.component = table.required_choice("component", directions());
  published.value = table.required<double>("value", Range::any());
  if (published.value == 0.0)
    table.fail("value", "= 0 must not be zero: results are reported as shares of it");
  published.source = table.required<std::string>("source");
  published.at = table.optional<Vector>("at", Range::any());
  if (!published.obstacles.empty() && (published.at || published.component.size() > 1)) {
    table.fail(
        "obstacles",
        "add up to a force, which has a component x, y or z and no `at`; leave out what is of motions");
  }
  if (published.at && published.component.size() > 1)
    table.fail("at", fmt::format("is for displacements; component is '{}'", published.component));
  if (measured) {
    if (!published.obstacles.empty()) table.fail("obstacles", "is for [[published]]; allowed here: set");
    published.scatter = table.required<double>("scatter", Range::at_least(0.0));
    if (table.optional<std::string>("of")) {
      const auto words = words_of(Feature{});
      const std::string word = table.required_choice("of", {words.begin(), words.end()});
      published.of = static_cast<Feature>(std::ranges::find(words, word) - words.begin());
    }
  } else {
    for (const auto& program : table.tables("programs")) published.programs.push_back(read_program(program));
  }
  table.finish();
  return published;
}

Profile read_profile(TableReader table) {
  Profile profile{.set = table.required<std::string>("set"),
                  .order = table.required_choice("order", directions())};
  table.finish();
  return profile;
}

/// A kappa as written: a number, "auto" (also when absent) or "best".
std::string read_kappa(TableReader& table) {
  if (table.holds_number("kappa"))
    return fmt::to_string(table.required<double>("kappa", Range::at_least(0.0)));
  return table.optional<std::string>("kappa") ? table.required_choice("kappa", {"auto", "best"}) : "auto";
}

Expectation read_expectation(TableReader table) {
  Expectation expected;
  expected.method = table.required_choice("method", method_names());
  expected.kappa = read_kappa(table);
  expected.reference = table.required_choice("reference", {"golden", "truth", "published", "measured"});
  const std::map<std::string, std::vector<std::string>> figures{
      {"published", {"relative_error"}}, {"measured", {"relative_error", "period_error"}}};
  const auto own = figures.find(expected.reference);
  expected.figure = table.required_choice(
      "figure",
      own != figures.end()
          ? own->second
          : std::vector<std::string>{"max_relative_error", "profile_relative_error", "rms_relative_error"});
  expected.below = table.optional<double>("below");
  expected.above = table.optional<double>("above");
  expected.reason = table.required<std::string>("reason");
  table.finish();
  if (expected.below.has_value() == expected.above.has_value()) {
    table.fail("below", "or above must be given, but not both");
  }
  return expected;
}

void read_comparison_table(TableReader table, const fs::path& folder, Comparison& comparison) {
  comparison.kappas =
      table.optional<std::vector<double>>("kappas", Range::at_least(0.0)).value_or(comparison.kappas);
  if (const auto golden = table.optional<std::string>("golden")) comparison.golden = folder / *golden;
  if (const auto truth = table.optional<std::string>("truth")) comparison.truth = folder / *truth;
  table.finish();
}

}  // namespace

Comparison read_comparison(const CaseSettings& settings) {
  Comparison comparison;
  std::error_code ignored;
  if (!fs::exists(settings.file, ignored)) return comparison;
  const CaseTables tables = read_case_tables(settings.file, settings.variants);
  TableReader reader(tables.root, settings.file, "");
  const fs::path folder = settings.file.parent_path();
  const char* golden = settings.quasi_static ? "golden" : "motion";
  comparison.golden = folder / ".." / "reference" / golden / (settings.name + ".h5");
  comparison.truth = folder / ".." / "reference" / "truth" / (settings.name + ".h5");
  if (auto profile = reader.table("profile")) comparison.profile = read_profile(*profile);
  if (auto table = reader.table("comparison")) read_comparison_table(*table, folder, comparison);
  for (const bool measured : {false, true}) {
    for (const auto& table : reader.tables(measured ? "measured" : "published"))
      comparison.published.push_back(read_published(table, measured));
  }
  for (const auto& table : reader.tables("expect"))
    comparison.expectations.push_back(read_expectation(table));
  return comparison;
}

Comparison read_comparison(const Scene& scene) {
  Comparison comparison = read_comparison(scene.settings);
  const auto require_set = [&](const char* key, const std::string& set) { node_set(scene, key, set); };
  std::vector<std::string> obstacles;
  for (const Movable& one : movable_of(scene.forces)) obstacles.emplace_back(one.name);
  if (comparison.profile) require_set("profile.set", comparison.profile->set);
  for (const auto& [set, component, value, source, programs, scatter, at, of, of_obstacles, over] :
       comparison.published) {
    const std::string table = scatter ? "measured" : "published";
    for (const std::string& name : of_obstacles) {
      if (std::ranges::find(obstacles, name) != obstacles.end()) continue;
      throw InputError(fmt::format("{}: {}.obstacles: '{}' is not an obstacle of the case; {}",
                                   scene.settings.file.string(), table, name, suggestion(name, obstacles)));
    }
    if (over > (scene.settings.quasi_static ? 0.0 : scene.settings.dynamics.duration)) {
      throw InputError(
          fmt::format("{}: {}.over = {} s is more than the duration; allowed: in a dynamic case, "
                      "a time at its end",
                      scene.settings.file.string(), table, over));
    }
    if (!of_obstacles.empty()) continue;
    require_set((table + ".set").c_str(), set);
    if (of != Feature::end && scene.settings.quasi_static) {
      throw InputError(fmt::format("{}: measured.of = '{}' is for dynamic cases; the answer is quasi-static",
                                   scene.settings.file.string(), words_of(of)[static_cast<std::size_t>(of)]));
    }
    if (!at || point_weights(scene.mesh.points, scene.sets.at(set), *at)) continue;
    throw InputError(fmt::format(
        "{}: {}.at = {} is not in the plane of the set '{}'; a point that moves with a set must be in the "
        "line, plane or space that its nodes span",
        scene.settings.file.string(), table, *at, set));
  }
  return comparison;
}

std::string describe_comparison_keys() {
  return R"(
[profile] set = NAME, order = "x" | "y" | "z" | "around-x" | "around-y" | "around-z"
[comparison] kappas = [numbers], golden = "FILE.h5", truth = "FILE.h5"
[[published]] set = NAME, component = "x", ... or "around-x", ..., value in m or rad: mean displacement or
  rotation of the set, source: a text; or, instead of set, obstacles = [NAMES], value in N: the sum of their
  forces on the body at the end; over = s (default: 0): its mean over so much time at the end, of all checks
  (check_interval)
[[measured]] the same keys, and scatter: of the repetitions; at = [x, y, z], also of [[published]]: a point that
  moves with the set, whose displacement replaces the mean; of = "end", "peak" or "period" (s): of a motion
[[published.programs]] program: its name and element, values = [numbers] of the same motion, elements = [number
  per side of each mesh, as in the names of variants] (default: one value, converged or on an unknown mesh), source
[[expect]] method, kappa (number, "auto" or "best"), reference ("golden", "truth", "published" or "measured"),
  figure, below or above, reason
)";
}

}  // namespace sandglass
