/// The hash of a case changes with everything that decides the exact answer, and with nothing else.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>
#include <type_traits>
#include <typeinfo>

#include "io/case_file.hpp"
#include "support/good_case.hpp"
#include "support/scenes.hpp"
#include "support/temporary_folder.hpp"

namespace sandglass::verification::case_hash_test {
namespace {

using good_case::good, good_case::own_mesh, good_case::two_boxes, good_case::with;

TEST(CaseFile, hash_follows_what_decides_the_answer_and_nothing_else) {
  const TemporaryFolder folder;
  const auto hash = [&](const std::string& text) {
    return read_scene(folder.write("a.toml", text)).case_hash;
  };
  const std::string once = hash(good);
  EXPECT_EQ(once.size(), 16U);
  EXPECT_EQ(hash(with("A block is pulled.", "Other words.")), once);
  EXPECT_EQ(hash(with("tolerance = 1e-7", "tolerance = 1e-6")), once);
  EXPECT_EQ(hash(with("below = 0.01", "below = 0.02")), once);
  EXPECT_NE(hash(with("poisson_ratio = 0.49", "poisson_ratio = 0.48")), once);
  EXPECT_NE(hash(with("elements = [1, 2, 3]", "elements = [1, 2, 4]")), once);
  const auto with_fibres = [&](const std::string& direction) {
    return hash(with("law = \"neo-hookean\"",
                     "law = \"fibre-neo-hookean\"\nfibre_modulus = 1.0\nfibre_direction = " + direction));
  };
  EXPECT_NE(with_fibres("[0, 0, 1]"), with_fibres("[0, 1, 1]"));
  EXPECT_NE(with_fibres("[0, 0, 1]"), with_fibres("[0, 0, 1]\nsheet_direction = [0, 1, 0]"));
  const auto with_volume = [&](const std::string& part) {
    return hash(with("density = 1000.0", "density = 1000.0\nvolumetric = \"" + part + "\""));
  };
  EXPECT_EQ(with_volume("quadratic"), once);
  EXPECT_NE(with_volume("logarithmic"), once);
  EXPECT_NE(with_volume("logarithmic"), with_volume("quadratic-logarithmic"));
  EXPECT_NE(hash(with("value = [0.5, 0.0, 0.3]", "value = [0.5, 0.0, 0.31]")), once);
  EXPECT_NE(hash(with("components = \"xz\"", "components = \"xyz\"")), once);
  EXPECT_NE(hash(with("top = { z = [3.0, 3.0] }", "top = { z = [2.0, 3.0] }")), once);
  const std::string forced = hash(good + "[[force]]\nset = \"top\"\ntotal = [0.0, 0.0, 1.0]\n");
  EXPECT_NE(forced, once);
  EXPECT_NE(hash(good + "[[force]]\nset = \"top\"\ntotal = [0.0, 0.0, 2.0]\n"), forced);
  EXPECT_NE(hash(good + "[[force]]\nset = \"top\"\nmoment = [0.0, 0.0, 1.0]\n"), forced);
  const std::string on = "[[force]]\nset = \"top\"\ntotal = [0.0, 0.0, 1.0]\non = ";
  EXPECT_EQ(hash(good + on + "\"faces\"\n"), forced);
  EXPECT_NE(hash(good + on + "\"nodes\"\n"), forced);
  EXPECT_EQ(hash(good + "[[published]]\nset = \"top\"\ncomponent = \"x\"\nvalue = 1.0\nsource = \"a\"\n"),
            once);
}

/// Another value of a declared parameter.
template <class Value>
void change(Value& value) {
  if constexpr (std::is_same_v<Value, std::string>) {
    value += "x";
  } else if constexpr (std::is_same_v<Value, Formula>) {
    value = Formula("t");
  } else if constexpr (std::is_same_v<Value, bool>) {
    value = !value;
  } else if constexpr (std::is_arithmetic_v<Value> || std::is_enum_v<Value>) {
    value = static_cast<Value>(static_cast<int>(value) + 1);
  } else if constexpr (requires { Value::value_type::parameters(); }) {
    value.emplace_back();
  } else {
    for (auto& one : value) one = std::isnan(one) ? 0 : one;  // was not given
    value.back() += 1;
  }
}

/// Calls use(name, changed) for each declared parameter of a table and of the tables in it; `changed` is the
/// table with another value for that parameter alone.
template <class Table, class Use>
void for_each_change(const Table& table, const Use& use) {
  const auto with_change = [&]<class Value>(const Parameter<Table, Value>& parameter) {
    Table changed = table;
    Value& value = changed.*(parameter.member);
    if constexpr (requires { Value::parameters(); }) {
      for_each_change(Value(value), [&](std::string_view name, const Value& other) {
        value = other;
        use(name, changed);
      });
    } else {
      change(value);
      use(parameter.name, changed);
    }
  };
  std::apply([&](const auto&... parameter) { (with_change(parameter), ...); }, Table::parameters());
}

/// Checks the hash of a static or dynamic case with a table.
struct HashedCase {
  Case description = plain_case(NeoHookean{.young_modulus = 3000.0, .poisson_ratio = 0.45});

  /// A declared parameter of a table changes the hash if and only if `decides(name)`. `put(case, table)` puts
  /// the table into a case.
  template <class Table, class Put, class Decides>
  void expect(const Table& table, const Put& put, const Decides& decides) const {
    const auto hash = [&](const Table& one) {
      Case with_table = description;
      put(with_table, one);
      return case_hash(with_table);
    };
    for_each_change(table, [&](std::string_view name, const Table& changed) {
      EXPECT_EQ(hash(changed) != hash(table), decides(name))
          << typeid(Table).name() << "." << name << (description.quasi_static ? " at rest" : " in motion");
    });
  }
};

/// A force whose load curve, if it has one, has points.
template <class Force>
Force with_a_curve() {
  Force force;
  if constexpr (requires { force.curve; }) force.curve = {.times = {0.0, 1.0}, .factors = {0.0, 1.0}};
  return force;
}

/// Whether a force's parameter changes how accurately an answer is computed, but not the exact answer.
template <class Force>
bool is_numerical(std::string_view parameter) {
  if constexpr (requires { Force::numerical; }) {
    return std::ranges::find(Force::numerical, parameter) != Force::numerical.end();
  } else {
    return false;
  }
}

TEST(CaseFile, hash_follows_every_declared_field_that_decides_the_answer) {
  const auto always = [](std::string_view /*name*/) { return true; };
  for (const bool is_static : {true, false}) {
    HashedCase hashed;
    hashed.description.quasi_static = is_static;
    const auto in_motion = [&](std::string_view /*name*/) { return !is_static; };
    for_each_type(Generators{}, [&]<class Generator>() {
      hashed.expect(
          Generator{}, [](Case& c, const Generator& mesh) { c.mesh = mesh; }, always);
    });
    for_each_type(Laws{}, [&]<class Law>() {
      hashed.expect(
          Law{}, [](Case& c, const Law& law) { c.materials.front().law = law; }, always);
    });
    for_each_type(Forces{}, [&]<class Force>() {
      hashed.expect(
          with_a_curve<Force>(), [](Case& c, const Force& one) { c.forces.of<Force>() = {one}; },
          [&](std::string_view name) {
            return !is_numerical<Force>(name) && (!is_static || name != Force::only_in_motion);
          });
    });
    Refinement split;
    split.numbers = {1};
    hashed.expect(
        split, [](Case& c, const Refinement& rule) { c.refinements = {rule}; }, always);
    hashed.expect(
        NodeTie{}, [](Case& c, const NodeTie& rule) { c.ties = {rule}; }, always);
    hashed.expect(
        InitialVelocity{.set = "start"},
        [](Case& c, const InitialVelocity& start) { c.velocities = {start}; }, in_motion);
    hashed.expect(
        DynamicsSettings{}, [](Case& c, const DynamicsSettings& settings) { c.dynamics = settings; },
        [&](std::string_view name) {
          return !is_static && (name == "duration" || name == "ramp_time" || name == "damping");
        });
    hashed.expect(
        RelaxationSettings{}, [](Case& c, const RelaxationSettings& settings) { c.relaxation = settings; },
        [](std::string_view /*name*/) { return false; });
  }
}

TEST(CaseFile, numerical_settings_follow_what_the_hash_leaves_out) {
  for_each_type(Forces{}, []<class Force>() {
    const auto settings = [](const Force& force) {
      HashedCase hashed;
      hashed.description.forces.of<Force>() = {force};
      return numerical_settings(hashed.description);
    };
    const auto force = with_a_curve<Force>();
    for_each_change(force, [&](std::string_view name, const Force& changed) {
      EXPECT_EQ(settings(changed) != settings(force), is_numerical<Force>(name))
          << Force::name << "." << name;
    });
  });
}

/// Fields of tables without declared parameters, each changed in the text of a case.
TEST(CaseFile, hash_follows_the_fields_of_other_tables) {
  const TemporaryFolder folder;
  const auto hash = [&](const std::string& text) {
    return case_hash(read_case_file(folder.write("a.toml", text)));
  };
  const std::string text = with("top = { z = [3.0, 3.0] }", R"(top = { z = [3.0, 3.0] }
round = { cylinder = { axis = "z", center = [0.0, 0.5], semi_axes = [1.0, 2.0] } }
oval = { ellipsoid = { center = [0.0, 0.0, 0.5], semi_axes = [1.0, 2.0, 3.0] } }
[element_sets]
half = { x = [0.25, inf] })") +
                           R"([[rotation]]
set = "round"
axis = "x"
angle = 10.0
center = [0.0, 1.5, 0.0]
displacement = [0.0, 0.0, 0.125]
)";
  const std::string once = hash(text);
  std::set<std::string> hashes{once};
  std::size_t changes = 0;
  for (const auto& [old, other] : std::vector<std::pair<std::string, std::string>>{
           {"[mesh]\n" + own_mesh + "\n", two_boxes},
           {"[mesh]\n" + own_mesh + "\n", replaced(two_boxes, "\"one\"", "\"three\"")},
           {"[mesh]\n" + own_mesh + "\n", replaced(two_boxes, "offset", "turn")},
           {"[mesh]\n" + own_mesh + "\n", replaced(two_boxes, "[1, 2, 3]", "[1, 2, 4]")},
           {"center = [0.0, 0.5]", "center = [0.1, 0.5]"},
           {"axis = \"z\"", "axis = \"y\""},
           {"semi_axes = [1.0, 2.0] ", "semi_axes = [1.0, 2.5] "},
           {"center = [0.0, 0.0, 0.5]", "center = [0.0, 0.0, 0.6]"},
           {"semi_axes = [1.0, 2.0, 3.0]", "semi_axes = [1.0, 2.0, 3.5]"},
           {"oval = {", "oval = { surface = true,"},
           {"oval = {", "ball = {"},
           {"half = { x", "half = { y"},
           {"x = [0.25, inf]", "x = [0.5, inf]"},
           {"set = \"round\"", "set = \"oval\""},
           {"axis = \"x\"", "axis = [1.0, 1.0, 0.0]"},
           {"angle = 10.0", "angle = 11.0"},
           {"center = [0.0, 1.5, 0.0]\n", ""},
           {"0.125", "0.25"},
           {"set = \"bottom\"\nvalue", "set = \"oval\"\nvalue"},
           {"value = [0.5, 0.0, 0.3]", "value = [0.5, 0.0, 0.4]"},
           {"components = \"xz\"", "components = \"xyz\""}}) {
    hashes.insert(hash(replaced(text, old, other)));
    EXPECT_EQ(hashes.size(), 1 + ++changes) << other;
  }
}

}  // namespace
}  // namespace sandglass::verification::case_hash_test
