/// Case files: reading valid ones, and meshes in files of their own.

#include "io/case_file.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "comparison/comparison.hpp"
#include "io/mesh_file.hpp"
#include "support/good_case.hpp"
#include "support/scenes.hpp"
#include "support/temporary_folder.hpp"

namespace sandglass::verification::case_file_test {
namespace {

using good_case::good, good_case::own_mesh, good_case::two_bodies, good_case::with;

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
