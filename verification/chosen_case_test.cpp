/// The [method] of a case, and the case that `sandglass choose` writes.

#include <gtest/gtest.h>

#include "choice/case_writer.hpp"
#include "choice/evaluation.hpp"
#include "choice/longer_steps.hpp"
#include "choice/variations.hpp"
#include "comparison/comparison.hpp"
#include "io/case_file.hpp"
#include "io/toml_text.hpp"
#include "problem/scene_refinement.hpp"
#include "support/temporary_folder.hpp"

namespace sandglass::verification::chosen_case_test {
namespace {

namespace fs = std::filesystem;

constexpr std::string_view head = R"(
[case]
name = "bar"
requirement = "A bar is pulled."
answer = "quasi-static"
[mesh]
generator = "box"
size = [0.1, 0.1, 0.2]
elements = [4, 4, 8]
[material]
law = "neo-hookean"
young_modulus = 3000
poisson_ratio = 0.3
density = 1000.0
[sets]
foot = { z = [0.0, 0.0] }
"a head" = { z = [0.2, inf] }
edge = { x = [0.025, 0.025], y = [0.0, 0.0] }
[[displacement]]
set = "foot"
value = [0.0, 0.0, 0.0]
[[displacement]]
set = "a head"
value = [0.0, 0.0, 0.02]
[profile]
set = "edge"
order = "z"
)";

class MethodTableTest : public ::testing::Test {
 protected:
  Case read(const std::string& table) {
    return read_case_file(folder.write("bar.toml", std::string(head) + table));
  }

  std::string refused(const std::string& table) {
    return input_error([&] { read("[method]\n" + table); });
  }

  TemporaryFolder folder;
};

TEST_F(MethodTableTest, is_read_and_changes_no_answer) {
  EXPECT_FALSE(read("").method);
  const Case plain = read("[method]\nname = \"tl-enhanced\"\n");
  ASSERT_TRUE(plain.method);
  EXPECT_EQ(plain.method->method, "tl-enhanced");
  EXPECT_EQ(plain.method->kappa, std::nullopt);
  EXPECT_EQ(plain.method->precision, Precision::double_precision);
  const Case full = read(
      "[method]\nname = \"tl-perturbation\"\nkappa = 0.02\nkappa_modulus = \"shear\"\nprecision = "
      "\"float\"\n");
  EXPECT_EQ(full.method->kappa, 0.02);
  EXPECT_EQ(full.method->kappa_modulus, KappaModulus::shear);
  EXPECT_EQ(full.method->precision, Precision::single_precision);
  EXPECT_EQ(case_hash(full), case_hash(read("")));
}

TEST_F(MethodTableTest, is_read_strictly) {
  EXPECT_TRUE(contains(refused("name = \"tl-perturbatio\"\n"), "did you mean 'tl-perturbation'"));
  EXPECT_TRUE(contains(refused("kappa = 0.1\n"), "method.name"));
  EXPECT_TRUE(contains(refused("name = \"tl-full\"\nkappa = 0.1\n"), "has no such parameter"));
  EXPECT_TRUE(contains(refused("name = \"tl-perturbation\"\nkappa = -1\n"), "[0, inf)"));
  EXPECT_TRUE(contains(refused("name = \"tl-perturbation\"\nkappa = \"best\"\n"), "auto"));
  EXPECT_TRUE(contains(refused("name = \"tl-perturbation\"\nprecision = \"half\"\n"), "float"));
  EXPECT_TRUE(contains(refused("name = \"tl-perturbation\"\nkapa = 1\n"), "did you mean 'kappa'"));
}

/// Every committed case and variant, written to another folder and read back, is the same, with its method.
TEST(CaseWriter, gives_back_every_case) {
  const TemporaryFolder folder;
  const MethodChoice choice{
      .method = "tl-perturbation", .kappa = 0.0123, .precision = Precision::single_precision};
  int written = 0;
  for (const auto& entry : fs::directory_iterator(fs::path(SANDGLASS_SOURCE) / "cases")) {
    if (entry.path().extension() != ".toml") continue;
    for (const Case& original : read_cases(entry.path())) {
      const Case again = read_case_file(
          folder.write("again.toml", case_text(original, choice, original, folder / "again.toml")));
      EXPECT_EQ(again.name, original.name);
      EXPECT_EQ(case_hash(again), case_hash(original)) << original.name;
      EXPECT_EQ(again.materials.front().density, original.materials.front().density);
      EXPECT_EQ(again.requirement, original.requirement);
      EXPECT_EQ(again.relaxation.max_steps, original.relaxation.max_steps);
      EXPECT_EQ(again.dynamics.duration, original.dynamics.duration);
      EXPECT_EQ(again.velocities.size(), original.velocities.size());
      const Comparison comparison = read_comparison(again), before = read_comparison(original);
      EXPECT_EQ(comparison.expectations.size(), before.expectations.size());
      EXPECT_EQ(comparison.published.size(), before.published.size());
      EXPECT_EQ(comparison.kappas, before.kappas);
      EXPECT_EQ(again.method->kappa, choice.kappa);
      EXPECT_EQ(again.method->precision, choice.precision);
      EXPECT_TRUE(!fs::exists(before.golden) || fs::equivalent(comparison.golden, before.golden));
      ++written;
    }
  }
  EXPECT_GE(written, 20);
}

/// A coarser mesh makes another case, with only what the run needs: the profile's nodes, for example, do not
/// exist on the coarser mesh.
TEST_F(MethodTableTest, goes_with_a_coarser_mesh) {
  const Case original = read("");
  for (const auto& mesh : coarser_meshes(std::get<AnyGenerator>(original.mesh))) {
    const Case coarser = on_mesh(mesh, original).description;
    const fs::path place = folder / "coarser.toml";
    const Case again = read_case_file(
        folder.write("coarser.toml", case_text(original, {.method = "tl-full"}, coarser, place)));
    EXPECT_EQ(case_hash(again), case_hash(coarser));
    EXPECT_NE(again.name, original.name);
    EXPECT_EQ(again.method->method, "tl-full");
    EXPECT_NO_THROW(read_scene(again));
  }
}

/// A set that only one table names keeps its nodes on a coarser mesh, whichever table it is; a set that no
/// table names may lose them.
TEST_F(MethodTableTest, keeps_every_set_that_a_table_names_on_coarser_meshes) {
  std::map<std::string, std::string> tables{
      {"refine", "[[refine]]\naround = \"lone\"\n"},
      {"tie", "[[tie]]\nset = \"lone\"\nelements = \"lower\"\n"},
      {"displacement", "[[displacement]]\nset = \"lone\"\nvalue = [0.0, 0.0, 0.0]\ncomponents = \"x\"\n"},
      {"rotation", "[[rotation]]\nset = \"lone\"\naxis = \"z\"\nangle = 0.0\n"},
  };
  for_each_type(Forces{}, [&]<class Force>() {
    if (!requires(Force force) { force.set; }) return;
    const std::string name(Force::name);
    tables[name] = "[[" + name + "]]\nset = \"lone\"\nvalue = 1.0\n";
  });
  tables["mass"] = "[[mass]]\nset = \"lone\"\ntotal = 1.0\n";
  tables["force"] = "[[force]]\nset = \"lone\"\ntotal = [0.1, 0.0, 0.0]\n";
  tables["support"] = "[[support]]\nset = \"lone\"\nstiffness = 1e3\n";
  tables["obstacle"] =
      "[[obstacle]]\nname = \"floor\"\nset = \"lone\"\nshape = \"plane\"\npoint = [0, 0, 0]\nnormal = [0.0, "
      "0.0, 1.0]\n";
  tables["contact"] = "[[contact]]\nname = \"self\"\nset = \"lone\"\n";
  for (const auto& [name, table] : tables) {
    // In the middle of the lower end; none of its nodes is a corner of an element that it is tied to.
    Case original = read("[element_sets]\nlower = { z = [0.0, 0.1] }\n" + table);
    original.sets.push_back({.name = "lone", .surface = true});
    original.sets.back().within[2] = Interval{0.0, 0.0};
    if (name == Obstacle::name) original.displacements.clear();  // held nodes feel none
    const auto coarser = coarser_meshes(std::get<AnyGenerator>(original.mesh));
    ASSERT_FALSE(coarser.empty());
    for (const auto& mesh : coarser) {
      const Scene scene = make_scene(on_mesh(mesh, original));
      EXPECT_FALSE(scene.sets.at("lone").empty()) << name;
      EXPECT_TRUE(scene.sets.at("edge").empty()) << name;
    }
  }
}

/// Longer steps are written; softer moduli make another case, to which the references do not apply.
TEST_F(MethodTableTest, goes_with_longer_steps) {
  const Case plain = read_case_file(fs::path(SANDGLASS_SOURCE) / "cases" / "plucked-beam.toml");
  std::vector<Case> originals{plain};
  std::string has_them = case_text(plain, {.method = "tl-full"}, plain, folder / "original.toml");
  has_them.insert(has_them.find("[dynamics]\n") + 11, "body_frequency = 1\n");
  originals.push_back(read_case_file(folder.write("original.toml", has_them)));
  for (const Case& original : originals) {
    for (const auto& [difference, longer] : longer_steps(with_mesh(original))) {
      const fs::path place = folder / "longer.toml";
      const Case again = read_case_file(
          folder.write("longer.toml", case_text(original, {.method = "tl-full"}, longer.description, place)));
      EXPECT_EQ(again.dynamics.body_frequency, 1);
      EXPECT_EQ(case_hash(again), case_hash(longer.description));
      EXPECT_EQ(again.name == original.name, case_hash(longer.description) == case_hash(original));
    }
  }
}

/// A refined case lists the elements that are split, besides its own [[refine]] tables.
TEST_F(MethodTableTest, goes_with_a_refined_mesh) {
  for (const std::string more : {"", "\n[[refine]]\naround = \"foot\"\n"}) {
    const Case original = read(more);
    const Case finer = refined(refined(original, {1, 2}), {0});
    const fs::path place = folder / "refined.toml";
    const Case again = read_case_file(
        folder.write("refined.toml", case_text(original, {.method = "tl-full"}, finer, place)));
    EXPECT_EQ(case_hash(again), case_hash(finer));
    EXPECT_NE(again.name, original.name);
    EXPECT_EQ(read_scene(again).mesh_hash, read_scene(finer).mesh_hash);
  }
}

TEST(TomlText, keeps_order_values_and_odd_words) {
  const std::string text = R"(answer = 42

[z]
b = 1.0
a = [1, 2.5e-30, inf]
"a b" = "quote \" and \\ and \n"

[[y]]
t = { deep = { x = true, e = "" } }

[[y]]
n = 0.1
)";
  const toml::table table = toml::parse(text);
  const std::string written = toml_text(table);
  EXPECT_EQ(toml::parse(written), table);
  EXPECT_LT(written.find("[z]"), written.find("[[y]]"));
  EXPECT_LT(written.find("b = 1.0"), written.find("a = ["));
  EXPECT_TRUE(contains(written, "n = 0.1\n"));
}

}  // namespace
}  // namespace sandglass::verification::chosen_case_test
