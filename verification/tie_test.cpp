/// Tied parts whose meshes do not match: which nodes follow which, the same answer as with hanging nodes,
/// wrong input.

#include <gtest/gtest.h>

#include "base/error.hpp"
#include "io/case_file.hpp"
#include "problem/scene_rules.hpp"
#include "solve/relaxation.hpp"
#include "support/case_text.hpp"
#include "support/scenes.hpp"
#include "support/static_answer.hpp"

namespace sandglass::verification::tie_test {
namespace {

constexpr double eps = std::numeric_limits<double>::epsilon();

/// A box on top of another, with nodes of its own.
Mesh two_boxes(const std::array<int, 3>& lower, const std::array<int, 3>& upper) {
  Mesh mesh = box({1, 1, 1}, lower);
  const Mesh other = box({1, 1, 1}, upper);
  const int first = static_cast<int>(mesh.points.size());
  for (const auto& [x, y, z] : other.points) mesh.points.push_back({x, y, z + 1.0});
  for (Hexahedron cell : other.cells) {
    for (int& node : cell) node += first;
    mesh.cells.push_back(cell);
  }
  return mesh;
}

/// Tables that tie the boxes, hold them below and move them above, followed by `more`.
std::string tables(const std::string& more) {
  return R"(
[sets]
bottom = { z = [0.0, 0.0] }
middle = { z = [1.0, 1.0] }
top = { z = [2.0, 2.0] }

[element_sets]
lower = { z = [-inf, 1.0] }
upper = { z = [1.0, inf] }

[[displacement]]
set = "bottom"
value = [0.0, 0.0, 0.0]

[[displacement]]
set = "top"
value = [0.2, 0.0, -0.2]
)" + more;
}

/// A case of a mesh, with these tables.
Scene scene_of(Mesh mesh, const std::string& more) {
  const std::string text = box_case("boxes", "[1.0, 1.0, 2.0]", "[1, 1, 1]") + tables(more);
  return read_scene(text.substr(0, text.find("[mesh]")) + text.substr(text.find("[material]")),
                    {.mesh = std::move(mesh)});
}

const std::string tied = "[[tie]]\nset = \"middle\"\nelements = \"lower\"\n";

Scene tied_boxes(const std::array<int, 3>& lower, const std::array<int, 3>& upper,
                 const std::string& more = tied) {
  return scene_of(two_boxes(lower, upper), more);
}

/// Nodes of the upper part on the common face, and no others, follow the face below like a linear field.
TEST(Tie, follows_linear_fields) {
  const Scene scene = tied_boxes({2, 2, 2}, {3, 3, 3});
  ASSERT_EQ(scene.ties.size(), 16u);
  NodalField u;
  const Tensor<double> H{{.1, .2, -.3, .4, .5, .6, -.7, .8, .9}};
  for (const Vector& X : scene.mesh.points) u.push_back(linear(H, X));
  NodalField followed = u;
  follow(scene.ties, followed);
  EXPECT_LT(largest_distance(u, followed), 16 * eps);
  for (const auto& [node, mean_of] : scene.ties) {
    EXPECT_LE(mean_of.size(), 4u);
    EXPECT_GE(node, 27);
    for (const auto& [free, weight] : mean_of)
      EXPECT_EQ(scene.mesh.points[static_cast<std::size_t>(free)][2], 1.0);
  }
}

/// If the nodes of the lower face are among those of the upper one, tied parts equal a refined mesh with
/// hanging nodes: the same equilibrium, up to the residual of 1e-8 of each, times ten for the condition
/// number.
TEST(Tie, has_the_answer_of_hanging_nodes) {
  const Scene scene = tied_boxes({2, 2, 2}, {4, 4, 4});
  const Scene refined = scene_of(box({1, 1, 2}, {2, 2, 4}), "[[refine]]\nelements = \"upper\"\n");
  for (const auto* method : {"tl-mean-dilatation", "tl-perturbation"}) {
    const NodalField u = static_answer(scene, {method}).u, expected = static_answer(refined, {method}).u;
    double largest = 0.0;
    int compared = 0;
    for (std::size_t n = 0; n < u.size(); ++n) {
      for (std::size_t m = 0; m < expected.size(); ++m) {
        if (distance(scene.mesh.points[n], refined.mesh.points[m]) > 1e-12) continue;
        largest = std::max(largest, distance(u[n], expected[m]));
        ++compared;
      }
    }
    EXPECT_EQ(compared, static_cast<int>(u.size())) << method;
    EXPECT_LT(largest, 10 * 1e-8 * largest_imposed(scene)) << method;
  }
}

/// Parts that do not match are joined too: the body stores as much energy as one mesh does, up to the effect
/// of the upper part's finer mesh (.4 %); unjoined parts would store none.
TEST(Tie, joins_parts_that_do_not_match) {
  const Scene scene = tied_boxes({4, 4, 4}, {5, 5, 5});
  const Scene whole = scene_of(box({1, 1, 2}, {4, 4, 8}), "");
  const Relaxation joined = static_answer(scene, {"tl-mean-dilatation"}),
                   one = static_answer(whole, {"tl-mean-dilatation"});
  EXPECT_NEAR(joined.energies.strain / one.energies.strain, 1.0, 0.01);
}

TEST(Tie, wrong_input_is_refused) {
  const auto message = [](const std::string& more) {
    try {
      tied_boxes({2, 2, 2}, {3, 3, 3}, more);
    } catch (const InputError& error) {
      return std::string(error.what());
    }
    return std::string("accepted");
  };
  const auto has = [&](const std::string& more, const std::string& words) {
    EXPECT_NE(message(more).find(words), std::string::npos) << message(more);
  };
  has("[[tie]]\nset = \"middle\"\nelements = \"none\"\n", "tie.elements");
  has("[[tie]]\nset = \"none\"\nelements = \"lower\"\n", "tie.set");
  has("[[tie]]\nset = \"top\"\nelements = \"lower\"\n", "is outside all elements of 'lower'");
  has("[[tie]]\nset = \"middle\"\n", "elements");
  has(tied + tied, "is tied by two tables");
  has(tied + "[[refine]]\nelements = \"lower\"\n", "leave out refine");
  has(tied + "[[displacement]]\nset = \"middle\"\nvalue = [0.0, 0.0, 0.0]\n", "is also driven");
}

}  // namespace
}  // namespace sandglass::verification::tie_test
