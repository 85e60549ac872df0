/// Case files with variants: the cases they define, and messages about invalid ones.

#include <gtest/gtest.h>

#include "comparison/comparison.hpp"
#include "io/case_file.hpp"
#include "support/case_text.hpp"
#include "support/scenes.hpp"
#include "support/temporary_folder.hpp"

namespace sandglass::verification::variants_test {
namespace {

/// A file with two axes; "size" is first in the file but last in the alphabet.
const std::string varied =
    replaced(box_case("bar", "[1.0, 1.0, 3.0]", "[1, 1, 1]"), "poisson_ratio = 0.49\n", "") + R"([sets]
bottom = { z = [0.0, 0.0] }
top = { z = [3.0, 3.0] }

[[displacement]]
set = "bottom"
value = [0.0, 0.0, 0.0]

[[displacement]]
set = "top"
value = [0.0, 0.0, 0.1]

[[variants.size]]
name = "1"

[[variants.size]]
name = "2"
mesh.elements = [2, 2, 6]

[[variants.nu]]
name = "nu0.3"
material.poisson_ratio = 0.3

[[variants.nu]]
name = "nu0.45"
material.poisson_ratio = 0.45

[[variants.nu]]
name = "pushed"
material.poisson_ratio = 0.2
material.young_modulus = 1000.0
displacement = [{ set = "bottom", value = [0.0, 0.0, 0.0] }]
force = [{ set = "top", total = [0.0, 0.0, -1.0] }]
)";

std::string with(const std::string& old, const std::string& replacement) {
  return replaced(varied, old, replacement);
}

TEST(Variants, every_combination_is_a_case_with_its_own_keys) {
  const TemporaryFolder folder;
  const auto cases = read_cases(folder.write("bar.toml", varied));
  std::vector<std::string> names;
  for (const auto& scene : cases) names.push_back(scene.name);
  EXPECT_EQ(names, (std::vector<std::string>{"bar-1-nu0.3", "bar-1-nu0.45", "bar-1-pushed", "bar-2-nu0.3",
                                             "bar-2-nu0.45", "bar-2-pushed"}));
  EXPECT_EQ(cases[4].family, "bar");
  EXPECT_EQ(cases[4].variants, (std::vector<std::string>{"2", "nu0.45"}));
  EXPECT_EQ(std::get<NeoHookean>(cases[4].materials.front().law).poisson_ratio, 0.45);
  EXPECT_EQ(std::get<NeoHookean>(cases[4].materials.front().law).young_modulus, 3000.0);  // tables are merged
  EXPECT_EQ(cases[4].displacements.size(), 2U);
  EXPECT_TRUE(cases[4].forces.of<DeadForce>().empty());
  EXPECT_EQ(std::get<NeoHookean>(cases[5].materials.front().law).young_modulus, 1000.0);
  EXPECT_EQ(cases[5].displacements.size(), 1U);  // lists are replaced
  EXPECT_EQ(cases[5].forces.of<DeadForce>().size(), 1U);
  EXPECT_EQ(read_comparison(cases[5]).golden.filename(), "bar-2-pushed.h5");
  EXPECT_EQ(read_scene(cases[0]).mesh.cells.size(), 1U);
  EXPECT_EQ(read_scene(cases[5]).mesh.cells.size(), 24U);
  EXPECT_NE(read_scene(cases[0]).case_hash, read_scene(cases[1]).case_hash);
}

/// A variant equals the same case in a separate file.
TEST(Variants, variant_has_the_hash_of_the_same_case_in_a_file_of_its_own) {
  const TemporaryFolder folder;
  const auto cases = read_cases(folder.write("bar.toml", varied));
  std::string alone = varied.substr(0, varied.find("[[variants"));
  alone.insert(alone.find("density"), "poisson_ratio = 0.45\n");
  EXPECT_EQ(read_scene(folder.write("alone.toml", alone)).case_hash, read_scene(cases[1]).case_hash);
}

TEST(Variants, file_with_variants_is_no_single_case) {
  const TemporaryFolder folder;
  const auto file = folder.write("bar.toml", varied);
  EXPECT_TRUE(contains(input_error([&] { read_scene(file); }), "has 6 variants, 'bar-1-nu0.3' and others"));
}

TEST(Variants, bad_ones_are_refused_with_file_line_and_rule) {
  const TemporaryFolder folder;
  const auto said = [&](const std::string& text) {
    const auto file = folder.write("bad.toml", text);
    return input_error([&] { read_cases(file); });
  };
  EXPECT_TRUE(contains(said(with("name = \"2\"", "name = \"a/b\"")),
                       "bad.toml:32: variants.size.name = 'a/b' must consist of letters"));
  EXPECT_TRUE(contains(said(with("name = \"2\"", "name = \"1\"")), "variants.size.name = '1' appears twice"));
  EXPECT_TRUE(contains(said(with("name = \"2\"\n", "")), "variants.size.name is missing"));
  // A variant's values are checked like all others, and errors name their place in the file.
  EXPECT_TRUE(contains(said(with("poisson_ratio = 0.3\n", "poisson_ratio = 0.6\n")),
                       "bad.toml:37: material.poisson_ratio = 0.6 must be in (-1, 0.5)"));
  EXPECT_TRUE(
      contains(said(with("mesh.elements", "mesh.element")), "bad.toml:33: mesh.element is not a key"));
  EXPECT_TRUE(contains(said(varied + "colour = \"red\"\n"), "colour is not a key of this table"));
}

}  // namespace
}  // namespace sandglass::verification::variants_test
