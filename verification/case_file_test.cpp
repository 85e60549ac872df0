/// Case files: reading valid ones, and messages about invalid ones.

#include "io/case_file.hpp"

#include <gtest/gtest.h>

#include <set>
#include <typeinfo>

#include "comparison/comparison.hpp"
#include "io/mesh_file.hpp"
#include "support/case_text.hpp"
#include "support/scenes.hpp"
#include "support/temporary_folder.hpp"

namespace sandglass::verification::case_file_test {
namespace {

const std::string good = box_case("good", "[1.0, 2.0, 3.0]", "[1, 2, 3]") + R"([sets]
bottom = { z = [0.0, 0.0] }
top = { z = [3.0, 3.0] }

[[displacement]]
set = "bottom"
value = [0.0, 0.0, 0.0]

[[displacement]]
set = "top"
value = [0.5, 0.0, 0.3]
components = "xz"

[profile]
set = "top"
order = "x"

[relaxation]
tolerance = 1e-7

[comparison]
kappas = [0.01, 0.02]

[[expect]]
method = "tl-perturbation"
kappa = 0.01
reference = "golden"
figure = "rms_relative_error"
below = 0.01
reason = "a test"
)";

std::string with(const std::string& old, const std::string& replacement) {
  return replaced(good, old, replacement);
}

const std::string own_mesh = "generator = \"box\"\nsize = [1.0, 2.0, 3.0]\nelements = [1, 2, 3]";

/// `good` in motion.
const std::string moving = with("\"quasi-static\"", "\"dynamic\"") + "[dynamics]\nduration = 2.0\n";

TEST(CaseFile, good_case_is_read_as_written) {
  const TemporaryFolder folder;
  const Scene scene = read_scene(folder.write("good.toml", good));
  const Case c = read_case_file(folder / "good.toml");
  EXPECT_EQ(c.name, "good");
  EXPECT_TRUE(c.quasi_static);
  EXPECT_EQ(scene.mesh.cells.size(), 6U);
  EXPECT_EQ(std::get<NeoHookean>(c.materials.front().law).young_modulus, 3000.0);
  EXPECT_EQ(std::get<NeoHookean>(c.materials.front().law).poisson_ratio, 0.49);
  EXPECT_EQ(c.materials.front().density, 1000.0);
  EXPECT_EQ(c.relaxation.tolerance, 1e-7);
  const Comparison comparison = read_comparison(scene);
  EXPECT_EQ(comparison.kappas, (std::vector<double>{0.01, 0.02}));
  ASSERT_EQ(comparison.expectations.size(), 1U);
  EXPECT_EQ(comparison.expectations[0].kappa, "0.01");
  EXPECT_EQ(comparison.expectations[0].below, 0.01);
  EXPECT_EQ(scene.sets.at("bottom").size(), 6U);
  EXPECT_EQ(scene.sets.at("top").size(), 6U);
  // Three components below, two above: y of the top is free.
  EXPECT_EQ(scene.constraints.size(), 6U * 3 + 6U * 2);
  for (const auto& constraint : scene.constraints) {
    const double z = scene.mesh.points[index(constraint.node)][2];
    const std::array<double, 3> top{0.5, NAN, 0.3};
    EXPECT_EQ(final_value(scene, constraint), z == 0.0 ? 0.0 : top[index(constraint.component)]);
  }
  EXPECT_DOUBLE_EQ(largest_imposed(scene), std::hypot(0.5, 0.3));
}

TEST(CaseFile, dynamic_case_is_read_as_written) {
  const TemporaryFolder folder;
  const auto text = with("\"quasi-static\"", "\"dynamic\"") +
                    "[[velocity]]\nvalue = [1, 2.5, -3]\n"
                    "[[velocity]]\nset = \"top\"\nspin = [0, 0, 2]\n"
                    "[[velocity]]\nvalue = [0, 0, 1]\nhalf_waves = [0, 0, 2]\n"
                    "[dynamics]\nduration = 2.0\ndamping = 0.5\n";
  const Case c = read_case_file(folder.write("dynamic.toml", text));
  EXPECT_FALSE(c.quasi_static);
  ASSERT_EQ(c.velocities.size(), 3U);
  EXPECT_EQ(c.velocities[0].set, "");
  EXPECT_EQ(c.velocities[0].value, (Vector{1.0, 2.5, -3.0}));
  EXPECT_EQ(c.velocities[0].spin, Vector{});
  EXPECT_EQ(c.velocities[0].half_waves, (std::array<int, 3>{}));
  EXPECT_EQ(c.velocities[1].set, "top");
  EXPECT_EQ(c.velocities[1].value, Vector{});
  EXPECT_EQ(c.velocities[1].spin, (Vector{0.0, 0.0, 2.0}));
  EXPECT_EQ(c.velocities[2].half_waves, (std::array<int, 3>{0, 0, 2}));
  EXPECT_EQ(c.dynamics.duration, 2.0);
  EXPECT_EQ(c.dynamics.damping, 0.5);
}

/// Several entries for one node add up: uniform motion, a wave over the height of 3 m, and a spin of the top
/// about its own centre of mass. Lumped masses of a plane of equal elements are symmetric, so that this is
/// the middle of the top, (0.5, 1); spin (0, 0, 2) moves X by 2 (1 - y, x - 0.5, 0).
TEST(CaseFile, initial_velocities_add_up) {
  const TemporaryFolder folder;
  const auto text = with("\"quasi-static\"", "\"dynamic\"") +
                    "[[velocity]]\nvalue = [1, 2.5, -3]\n"
                    "[[velocity]]\nset = \"top\"\nspin = [0, 0, 2]\n"
                    "[[velocity]]\nvalue = [0, 0, 4]\nhalf_waves = [0, 0, 1]\n"
                    "[dynamics]\nduration = 2.0\n";
  const Scene scene = read_scene(folder.write("dynamic.toml", text));
  ASSERT_EQ(scene.initial_velocities.size(), scene.mesh.points.size());
  for (std::size_t n = 0; n < scene.mesh.points.size(); ++n) {
    const auto [x, y, z] = scene.mesh.points[n];
    const double top = z > 2.9 ? 1.0 : 0.0;
    const Vector& v = scene.initial_velocities[n];
    EXPECT_NEAR(v[0], 1.0 + top * 2.0 * (1.0 - y), 1e-14);
    EXPECT_NEAR(v[1], 2.5 + top * 2.0 * (x - 0.5), 1e-14);
    EXPECT_NEAR(v[2], -3.0 + 4.0 * std::cos(std::numbers::pi * z / 3.0), 1e-14);
  }
  EXPECT_TRUE(read_scene(folder.write("good.toml", good)).initial_velocities.empty());
}

/// Half waves span the set from end to end, wherever it is: two along x from -2 to 1 and three along z from 5
/// to 7, as a product.
TEST(CaseFile, waves_stand_between_the_ends_of_the_set) {
  Mesh mesh = box({3.0, 1.0, 2.0}, {4, 1, 5});
  for (auto& X : mesh.points) X = {X[0] - 2.0, X[1], X[2] + 5.0};
  Case description = plain_case(NeoHookean{.young_modulus = 3000.0, .poisson_ratio = 0.49});
  description.velocities = {{.value = {0.5, 2.0, -1.0}, .half_waves = {2, 0, 3}}};
  const Scene scene = make_scene(description, mesh);
  for (std::size_t n = 0; n < mesh.points.size(); ++n) {
    const auto& [x, y, z] = mesh.points[n];
    const double wave =
        std::cos(std::numbers::pi * 2 * (x + 2.0) / 3.0) * std::cos(std::numbers::pi * 3 * (z - 5.0) / 2.0);
    const Vector& v = scene.initial_velocities[n];
    for (std::size_t i = 0; i < 3; ++i) {
      EXPECT_NEAR(v[i], wave * description.velocities[0].value[i], 1e-14);
    }
  }
}

/// The centre of mass follows from masses, not from the mean of the nodes: two elements of lengths 1 and 3
/// have theirs at 2, their nodes at (0 + 1 + 4) / 3.
TEST(CaseFile, spin_is_about_the_centre_of_mass) {
  Mesh mesh = box({2.0, 1.0, 1.0}, {2, 1, 1});
  for (auto& X : mesh.points) X[0] = X[0] < 1.5 ? X[0] : 4.0;
  Case description = plain_case(NeoHookean{.young_modulus = 3000.0, .poisson_ratio = 0.49});
  description.velocities = {{.spin = {0.0, 0.0, 1.0}}};
  const Scene scene = make_scene(description, mesh);
  for (std::size_t n = 0; n < mesh.points.size(); ++n) {
    EXPECT_NEAR(scene.initial_velocities[n][1], mesh.points[n][0] - 2.0, 1e-14);
  }
}

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

/// Two boxes in place of the box of `good`.
const std::string two_boxes = R"([[mesh.bodies]]
name = "one"
generator = "box"
size = [1.0, 2.0, 3.0]
elements = [1, 2, 3]

[[mesh.bodies]]
name = "two"
offset = [0.0, 0.0, 3.0]
generator = "box"
size = [1.0, 2.0, 3.0]
elements = [1, 1, 1]
)";
const std::string two_bodies = with("[mesh]\n" + own_mesh + "\n", two_boxes);

TEST(CaseFile, bodies_have_sets_which_rules_may_replace) {
  const TemporaryFolder folder;
  const Scene scene = read_scene(folder.write("a.toml", two_bodies));
  EXPECT_EQ(scene.mesh.cells.size(), 7U);
  EXPECT_EQ(scene.sets.at("one").size(), 24U);
  EXPECT_EQ(scene.element_sets.at("two"), (std::vector<int>{6}));
  EXPECT_EQ(scene.sets.at("top").size(), 10U);  // of both bodies, as the rule is about positions
  const Scene other =
      read_scene(folder.write("b.toml", replaced(two_bodies, "top =", "two = { y = [0.0, 0.0] }\ntop =")));
  EXPECT_EQ(other.sets.at("two").size(), 12U);
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

const std::string published =
    "[[published]]\nset = \"top\"\ncomponent = \"x\"\nvalue = 1.0\nsource = \"a\"\n";
std::string measured(const std::string& keys) {
  return "[[measured]]\nset = \"top\"\ncomponent = \"x\"\nvalue = 1.0\nsource = \"a\"\n" + keys;
}

/// An obstacle above the body.
const std::string pressed =
    "[[obstacle]]\nname = \"tool\"\nset = \"top\"\nshape = \"plane\"\npoint = [0, 0, 4.0]\n"
    "normal = [0, 0, -1.0]\n";

/// A published force.
std::string force(const std::string& of, const std::string& component) {
  return fmt::format("[[published]]\n{}\ncomponent = \"{}\"\nvalue = 1.0\nsource = \"a\"\n", of, component);
}
const std::string program = "[[published.programs]]\nprogram = \"b\"\nsource = \"c\"\n";

struct BadCase {
  const char* name;
  std::string text;
  std::vector<std::string> said;  ///< required parts of the message, besides the file's name
};

void PrintTo(const BadCase& bad, std::ostream* stream) {
  *stream << bad.name;
}

class BadCaseTest : public ::testing::TestWithParam<BadCase> {};

TEST_P(BadCaseTest, is_refused_with_file_key_value_and_rule) {
  const TemporaryFolder folder;
  const auto file = folder.write("bad.toml", GetParam().text);
  const std::string text = input_error([&] { read_comparison(read_scene(file)); });
  EXPECT_TRUE(contains(text, file.string()));
  for (const auto& part : GetParam().said) EXPECT_TRUE(contains(text, part));
}

INSTANTIATE_TEST_SUITE_P(
    Table, BadCaseTest,
    ::testing::Values(
        BadCase{"not_toml", "[case\nname = 3", {":1: is not TOML"}},
        BadCase{"empty_file", "", {"case is missing"}},
        BadCase{"unknown_key",
                with("tolerance = 1e-7", "tolerence = 1e-7"),
                {"bad.toml:35: relaxation.tolerence", "did you mean 'tolerance'?"}},
        BadCase{"unknown_table", good + "[wind]\ng = 9.81\n", {"wind is not a key"}},
        BadCase{"misspelt_required_key",
                with("young_modulus = ", "young_moduls = "),
                {"material.young_moduls", "did you mean 'young_modulus'?"}},
        BadCase{"missing_key", with("density = 1000.0\n", ""), {"material.density is missing"}},
        BadCase{"missing_table", with("[mesh]\n" + own_mesh + "\n", ""), {"mesh is missing"}},
        BadCase{"text_for_a_number",
                with("young_modulus = 3000.0", "young_modulus = \"soft\""),
                {"bad.toml:13: material.young_modulus = 'soft' must be a number"}},
        BadCase{"fraction_for_an_integer",
                with("elements = [1, 2, 3]", "elements = [1, 2.5, 3]"),
                {"mesh.elements = [1, 2.5, 3] must be a list of 3, each an integer"}},
        BadCase{"two_entries_for_three",
                with("size = [1.0, 2.0, 3.0]", "size = [0.04, -0.05]"),
                {"mesh.size = [0.04, -0.05] must be a list of 3"}},
        BadCase{"number_for_a_table",
                with("bottom = { z = [0.0, 0.0] }", "bottom = 3"),
                {"sets.bottom = 3 must be a table"}},
        BadCase{"poisson_ratio_half",
                with("poisson_ratio = 0.49", "poisson_ratio = 0.5"),
                {"material.poisson_ratio = 0.5 must be in (-1, 0.5)"}},
        BadCase{"fibres_without_a_direction",
                with("law = \"neo-hookean\"",
                     "law = \"fibre-neo-hookean\"\nfibre_modulus = 1.0\nfibre_direction = [0, 0.0, 0]"),
                {"bad.toml:14: material.fibre_direction", "[0, 0, 0]", "length must not be zero"}},
        BadCase{"fibres_missing",
                with("law = \"neo-hookean\"", "law = \"fibre-neo-hookean\"\nfibre_modulus = 1.0"),
                {"material.fibre_direction or fibres must be given", "fibre-neo-hookean"}},
        BadCase{"fibres_of_an_isotropic_law",
                with("law = \"neo-hookean\"", "law = \"neo-hookean\"\nfibre_direction = [0, 0, 1]"),
                {"material.fibre_direction was given", "neo-hookean", "isotropic"}},
        BadCase{"sheets_along_fibres",
                with("law = \"neo-hookean\"",
                     "law = \"fibre-neo-hookean\"\nfibre_modulus = 1.0\nfibre_direction = [0, 0, 1]\n"
                     "sheet_direction = [0, 0, -2]"),
                {"material.fibre_direction", "sheets and fibres have the same direction"}},
        BadCase{"radii_that_decrease",
                with("law = \"neo-hookean\"",
                     "law = \"fibre-neo-hookean\"\nfibre_modulus = 1.0\n"
                     "fibres = { axis = \"z\", radii = [0.2, 0.1], angles = [60, -60] }"),
                {"material.fibres.radii = [0.2, 0.1] must increase"}},
        BadCase{"file_of_fibres_missing",
                with("law = \"neo-hookean\"",
                     "law = \"fibre-neo-hookean\"\nfibre_modulus = 1.0\nfibres = { file = \"none.txt\" }"),
                {"none.txt: cannot be read"}},
        BadCase{"volumetric_part_unknown",
                with("density = 1000.0", "density = 1000.0\nvolumetric = \"cubic\""),
                {"material.volumetric = 'cubic'", "logarithmic"}},
        BadCase{"volumetric_part_of_a_law_that_has_none",
                with("law = \"neo-hookean\"", "law = \"st-venant-kirchhoff\"\nvolumetric = \"logarithmic\""),
                {"material.volumetric must be left out", "st-venant-kirchhoff"}},
        BadCase{"rule_between_parameters",
                with("law = \"neo-hookean\"\nyoung_modulus = 3000.0\npoisson_ratio = 0.49",
                     "law = \"yeoh\"\nc1 = 100.0\nc2 = -30.0\nc3 = 2.0\nbulk_modulus = 1e4"),
                {"bad.toml:14: material.c2 = -30 must be at least 0", "3 c1 c3 = 600"}},
        BadCase{"poisson_ratio_above",
                with("poisson_ratio = 0.49", "poisson_ratio = 0.6"),
                {"= 0.6 must be in (-1, 0.5)"}},
        BadCase{"poisson_ratio_minus_one",
                with("poisson_ratio = 0.49", "poisson_ratio = -1"),
                {"= -1 must be in (-1, 0.5)"}},
        BadCase{"poisson_ratio_nan",
                with("poisson_ratio = 0.49", "poisson_ratio = nan"),
                {"= nan must be in (-1, 0.5)"}},
        BadCase{"young_modulus_zero",
                with("young_modulus = 3000.0", "young_modulus = 0.0"),
                {"material.young_modulus = 0 must be in (0, inf)"}},
        BadCase{"young_modulus_infinite",
                with("young_modulus = 3000.0", "young_modulus = inf"),
                {"= inf must be in (0, inf)"}},
        BadCase{"density_negative",
                with("density = 1000.0", "density = -1.0"),
                {"material.density = -1 must be in (0, inf)"}},
        BadCase{"no_elements",
                with("elements = [1, 2, 3]", "elements = [1, 0, 3]"),
                {"mesh.elements = 0 must be in [1, inf)"}},
        BadCase{"tolerance_negative",
                with("tolerance = 1e-7", "tolerance = -1.0"),
                {"relaxation.tolerance = -1"}},
        BadCase{"kappa_negative",
                with("kappas = [0.01, 0.02]", "kappas = [0.01, -0.02]"),
                {"comparison.kappas = -0.02"}},
        BadCase{"kappa_unknown_word",
                with("kappa = 0.01", "kappa = \"automatic\""),
                {"expect.kappa", "auto, best"}},
        BadCase{"unknown_law",
                with("law = \"neo-hookean\"", "law = \"neo-hokean\""),
                {"material.law = 'neo-hokean' is not known", "did you mean 'neo-hookean'?"}},
        BadCase{"body_without_name",
                replaced(two_bodies, "name = \"two\"", "name = \"\""),
                {"mesh.bodies.name = '' must be a word without '/'"}},
        BadCase{"two_bodies_of_one_name",
                replaced(two_bodies, "\"two\"", "\"one\""),
                {"mesh.bodies.name = 'one' appears twice; every body needs its own name"}},
        BadCase{"bodies_that_overlap",
                replaced(two_bodies, "offset = [0.0, 0.0, 3.0]", "offset = [0.1, 0.0, 2.0]"),
                {"mesh.bodies: the point (", "is in two bodies; allowed: bodies that do not intersect"}},
        BadCase{"bodies_beside_a_generator",
                replaced(two_bodies, "[[mesh.bodies]]\nname = \"one\"",
                         "[mesh]\ngenerator = \"box\"\n\n[[mesh.bodies]]\nname = \"one\""),
                {"mesh.generator is not a key"}},
        BadCase{"misspelt_key_of_a_body",
                replaced(two_bodies, "offset", "ofset"),
                {"mesh.bodies.ofset", "did you mean 'offset'?"}},
        BadCase{"focus_outside_of_the_ball",
                with(own_mesh,
                     "generator = \"ellipsoid\"\nsemi_axes = [1.0, 1.0, 1.0]\ncore_elements = 2\n"
                     "shell_layers = 1\nfocus = [0.8, 0.6, 0.0]"),
                {"mesh.focus = [0.8, 0.6, 0] must be in the unit ball"}},
        BadCase{"unknown_generator",
                with("generator = \"box\"", "generator = \"torus\""),
                {"mesh.generator = 'torus' is not known", "known: box, ellipsoid, cylinder"}},
        BadCase{"unknown_method",
                with("method = \"tl-perturbation\"", "method = \"tl-nothing\""),
                {"expect.method = 'tl-nothing'", "nearest of 20: tl-none"}},
        BadCase{"unknown_answer",
                with("\"quasi-static\"", "\"static\""),
                {"case.answer = 'static'", "quasi-static, dynamic"}},
        BadCase{"both_limits", with("below = 0.01", "below = 0.01\nabove = 0.5"), {"below", "but not both"}},
        BadCase{"no_limit", with("below = 0.01\n", ""), {"below", "but not both"}},
        BadCase{"empty_set",
                with("top = { z = [3.0, 3.0] }", "top = { z = [4.0, 5.0] }"),
                {"sets.top selects no node"}},
        BadCase{"interval_turned",
                with("top = { z = [3.0, 3.0] }", "top = { z = [5.0, 4.0] }"),
                {"sets.top.z", "low end first"}},
        BadCase{"set_of_a_displacement",
                with("set = \"top\"\nvalue", "set = \"tap\"\nvalue"),
                {"displacement.set = 'tap' is not a node set", "did you mean 'top'?"}},
        BadCase{"set_of_the_profile",
                with("set = \"top\"\norder", "set = \"tip\"\norder"),
                {"profile.set = 'tip'"}},
        BadCase{"wrong_component",
                with("components = \"xz\"", "components = \"xw\""),
                {"displacement.components = 'xw'"}},
        BadCase{"force_on_nothing",
                good + "[[force]]\nset = \"tip\"\ntotal = [0.0, 0.0, 1.0]\n",
                {"force.set = 'tip' is not a node set", "did you mean 'top'?"}},
        BadCase{"force_without_total_and_moment",
                good + "[[force]]\nset = \"top\"\n",
                {"force.total or moment must be given"}},
        BadCase{"infinite_force",
                good + "[[force]]\nset = \"top\"\ntotal = [0.0, inf, 1.0]\n",
                {"force.total = inf must be in (-inf, inf)"}},
        BadCase{"force_on_edges",
                good + "[[force]]\nset = \"top\"\ntotal = [0.0, 0.0, 1.0]\non = \"edges\"\n",
                {"force.on = 'edges' is not known", "faces, nodes"}},
        BadCase{"moment_on_nodes",
                good + "[[force]]\nset = \"top\"\nmoment = [0.0, 0.0, 1.0]\non = \"nodes\"\n",
                {"force.moment acts on faces"}},
        BadCase{"published_value_of_nothing",
                good + "[[published]]\nset = \"tip\"\ncomponent = \"x\"\nvalue = 1.0\nsource = \"a\"\n",
                {"published.set = 'tip' is not a node set"}},
        BadCase{"published_zero",
                good + "[[published]]\nset = \"top\"\ncomponent = \"x\"\nvalue = 0.0\nsource = \"a\"\n",
                {"published.value = 0 must not be zero"}},
        BadCase{"force_of_an_unknown_obstacle",
                good + force("obstacles = [\"tool\"]", "z"),
                {"published.obstacles: 'tool' is not an obstacle"}},
        BadCase{"force_of_a_set",
                good + force("obstacles = [\"tool\"]\nset = \"top\"", "z"),
                {"published.obstacles was given with set"}},
        BadCase{"mean_force_at_rest",
                good + pressed + force("obstacles = [\"tool\"]\nover = 0.1", "z"),
                {"published.over = 0.1 s is more than the duration"}},
        BadCase{"move_without_a_displacement",
                good + pressed + "[[obstacle.move]]\ntimes = [0.0]\nfactors = [1.0]\n",
                {"obstacle.move.displacement is missing"}},
        BadCase{"move_with_a_longer_list",
                good + pressed +
                    "[[obstacle.move]]\ndisplacement = [0, 0, 1]\ntimes = [0.0, 1.0]\nfactors = [1.0]\n",
                {"obstacle.move.times needs times and factors, one factor for each time"}},
        BadCase{
            "move_with_a_table_and_a_formula",
            good + pressed + "[[obstacle.move]]\ndisplacement = [0, 0, 1]\ntimes = [0.0]\nformula = \"t\"\n",
            {"obstacle.move.formula was given with times or factors"}},
        BadCase{"curve_of_no_displacement",
                good + pressed + "times = [0.0]\nfactors = [1.0]\n",
                {"obstacle.displacement is needed with times"}},
        BadCase{"force_around_an_axis",
                good + force("obstacles = [\"tool\"]", "around-z"),
                {"published.obstacles add up to a force, which has a component x, y or z"}},
        BadCase{"published_component",
                good + "[[published]]\nset = \"top\"\ncomponent = \"w\"\nvalue = 1.0\nsource = \"a\"\n",
                {"published.component = 'w' is not known", "x, y, z, around-x"}},
        BadCase{"program_without_a_source",
                good + published + "[[published.programs]]\nprogram = \"b\"\nvalues = [1.0]\n",
                {"published.programs.source is missing"}},
        BadCase{"program_with_an_unknown_key",
                good + published + program + "values = [1.0]\nmesh = [4]\n",
                {"published.programs.mesh is not a key of this table"}},
        BadCase{"program_with_a_value_too_few",
                good + published + program + "elements = [4, 8]\nvalues = [1.0]\n",
                {"published.programs.values has 1 numbers; 2 expected"}},
        BadCase{"program_with_no_mesh_and_two_values",
                good + published + program + "values = [1.0, 2.0]\n",
                {"published.programs.values has 2 numbers; 1 expected"}},
        BadCase{"measured_without_scatter", good + measured(""), {"measured.scatter is missing"}},
        BadCase{"measured_beside_the_plane_of_its_set",
                good + measured("scatter = 0.1\nat = [0.0, 0.0, 3.1]\n"),
                {"measured.at = [0, 0, 3.1] is not in the plane of the set 'top'"}},
        BadCase{"period_of_a_static_answer",
                good + measured("scatter = 0.1\nof = \"period\"\n"),
                {"measured.of = 'period' is for dynamic cases"}},
        BadCase{"unknown_feature",
                good + measured("scatter = 0.1\nof = \"phase\"\n"),
                {"measured.of = 'phase' is not known", "end, peak, period"}},
        BadCase{"scatter_of_a_published_value",
                good + published + "scatter = 0.1\n",
                {"published.scatter is not a key of this table"}},
        BadCase{"negative_mass",
                good + "[[mass]]\nset = \"top\"\ntotal = -1.0\n",
                {"mass.total = -1 must be in [0, inf)"}},
        BadCase{"mass_on_nothing",
                good + "[[mass]]\nset = \"tip\"\ntotal = 1.0\n",
                {"mass.set = 'tip' is not a node set"}},
        BadCase{"figure_of_another_reference",
                with("reference = \"golden\"", "reference = \"published\""),
                {"expect.figure = 'rms_relative_error' is not known", "relative_error"}},
        BadCase{"infinite_displacement",
                with("value = [0.5, 0.0, 0.3]", "value = [0.5, 0.0, inf]"),
                {"displacement.value = inf"}},
        BadCase{"node_driven_twice_differently",
                with("set = \"top\"\nvalue", "set = \"bottom\"\nvalue"),
                {"node 0 is given two displacements in x: 0 by set 'bottom' and 0.5 by set 'bottom'"}},
        BadCase{"velocity_of_a_static_answer",
                good + "[[velocity]]\nvalue = [0.0, 0.0, 1.0]\n",
                {"velocity is not a key"}},
        BadCase{"velocity_of_nothing",
                moving + "[[velocity]]\nset = \"tip\"\nvalue = [0.0, 0.0, 1.0]\n",
                {"velocity.set = 'tip' is not a node set", "did you mean 'top'?"}},
        BadCase{"velocity_without_value_and_spin",
                moving + "[[velocity]]\nset = \"top\"\n",
                {"velocity.value or spin must be given"}},
        BadCase{"infinite_spin",
                moving + "[[velocity]]\nspin = [0.0, inf, 1.0]\n",
                {"velocity.spin = inf must be in (-inf, inf)"}},
        BadCase{"negative_half_waves",
                moving + "[[velocity]]\nvalue = [0.0, 0.0, 1.0]\nhalf_waves = [0, -1, 0]\n",
                {"velocity.half_waves = -1 must be in [0, inf)"}},
        BadCase{"wave_without_extent",
                moving + "[[velocity]]\nset = \"top\"\nvalue = [0.0, 0.0, 1.0]\nhalf_waves = [0, 0, 1]\n",
                {"velocity.half_waves = 1 along z: the set top has no extent along z"}},
        BadCase{"key_of_old", moving + "[initial]\nvelocity = [0.0, 0.0, 1.0]\n", {"initial is not a key"}},
        BadCase{"dynamic_without_duration",
                with("\"quasi-static\"", "\"dynamic\"") + "[dynamics]\nframes = 3\n",
                {"dynamics.duration is missing"}}),
    [](const auto& parameter) { return std::string(parameter.param.name); });

TEST(CaseFile, missing_file_is_named) {
  const TemporaryFolder folder;
  EXPECT_TRUE(
      contains(input_error([&] { read_scene(folder / "none.toml"); }), "none.toml: no such case file"));
}

/// `good` with mesh and sets from a file.
std::string with_mesh_file() {
  std::string text = with(own_mesh, "file = \"mesh.h5\"");
  const auto sets_at = text.find("[sets]");
  return text.erase(sets_at, text.find("[[displacement]]") - sets_at);
}

TEST(CaseFile, missing_mesh_file_is_named) {
  const TemporaryFolder folder;
  const auto file = folder.write("bad.toml", with(own_mesh, "file = \"none.h5\""));
  EXPECT_TRUE(contains(input_error([&] { read_scene(file); }), "none.h5: no such file"));
}

TEST(CaseFile, inverted_elements_of_a_mesh_file_are_named) {
  const TemporaryFolder folder;
  Scene scene = read_scene(folder.write("good.toml", good));
  for (auto& cell : scene.mesh.cells) {
    for (std::size_t n = 0; n < 4; ++n) std::swap(cell[n], cell[n + 4]);
  }
  write_mesh_file(scene, folder / "mesh.h5");
  const auto file = folder.write("bad.toml", with(own_mesh, "file = \"mesh.h5\""));
  const std::string text = input_error([&] { read_scene(file); });
  EXPECT_TRUE(contains(text, "bad.toml"));
  EXPECT_TRUE(contains(text, "6 of 6 elements are inverted"));
  EXPECT_TRUE(contains(text, "element 0: centre (0.5, 0.5, 0.5), det J = -0.125"));
}

TEST(CaseFile, empty_sets_of_a_mesh_file_move_nothing) {
  const TemporaryFolder folder;
  Scene scene = read_scene(folder.write("good.toml", good));
  const std::string set = scene.driven.front().name;
  scene.sets.at(set).clear();
  write_mesh_file(scene, folder / "mesh.h5");
  const auto file = folder.write("bad.toml", with_mesh_file());
  EXPECT_TRUE(contains(input_error([&] { read_scene(file); }),
                       "displacement.set = '" + set + "' has no node in the mesh"));
}

/// A mesh written to a file and read back with its sets gives the same scene.
TEST(CaseFile, mesh_file_gives_the_same_scene) {
  const TemporaryFolder folder;
  const Scene scene = read_scene(folder.write("good.toml", good));
  write_mesh_file(scene, folder / "mesh.h5");
  const Scene again = read_scene(folder.write("again.toml", with_mesh_file()));
  EXPECT_EQ(again.mesh.points, scene.mesh.points);
  EXPECT_EQ(again.mesh.cells, scene.mesh.cells);
  EXPECT_EQ(again.sets, scene.sets);
  EXPECT_EQ(again.mesh_hash, scene.mesh_hash);
}

}  // namespace
}  // namespace sandglass::verification::case_file_test
