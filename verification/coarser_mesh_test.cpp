/// Coarser meshes of one body, and interpolation between them.

#include <gtest/gtest.h>

#include <algorithm>

#include "mesh/interpolation.hpp"
#include "mesh/variations.hpp"
#include "support/scenes.hpp"

namespace sandglass::verification {
namespace {

/// One mesh of every generator, with counts that the rules of all of them allow.
std::vector<AnyGenerator> sample_generators() {
  return {BoxMesh{{0.1, 0.2, 0.4}, {2, 3, 4}},
          EllipsoidMesh{.semi_axes = {0.1, 0.085, 0.08}, .core_elements = 4, .shell_layers = 2},
          CylinderMesh{.radius = 0.1, .height = 0.2, .core_elements = 4, .rings = 2, .layers = 4},
          BeamMesh{.size = {1.0, 0.2, 0.1}, .elements = {6, 2, 2}, .alternating_slant = 0.3}};
}

/// Trilinear forms hold linear fields, and continue them outside: the field at the nodes of the finer mesh,
/// some of them outside a coarser one with a curved boundary, is the linear one up to roundoff, 1e-13 of the
/// parent point times gradient times size.
TEST(Interpolation, gives_linear_fields_exactly_between_meshes_of_one_body) {
  const Tensor<double> H{0.3, -0.2, 0.1, 0.5, 0.7, -0.4, 0.2, 0.9, -0.6};
  for (const auto& generator : sample_generators()) {
    const Mesh fine = generate_mesh(generator);
    for (const auto& coarser : coarser_meshes(generator)) {
      const Mesh coarse = generate_mesh(coarser);
      NodalField u;
      for (const auto& X : coarse.points) u.push_back(linear(H, X));
      const NodalField there = interpolate(coarse, u, fine.points);
      for (std::size_t n = 0; n < fine.points.size(); ++n) {
        const Vector expected = linear(H, fine.points[n]);
        for (std::size_t i = 0; i < 3; ++i) EXPECT_NEAR(there[n][i], expected[i], 1e-11);
      }
    }
  }
}

/// At its own nodes a field is itself; a trilinear field of one element is its form, x y z here.
TEST(Interpolation, follows_the_trilinear_form) {
  const Mesh cube = box({1.0, 1.0, 1.0}, {1, 1, 1});
  NodalField u;
  for (const auto& X : cube.points) u.push_back({X[0] * X[1] * X[2], X[0] * X[1], 1.0});
  for (const auto& X : NodalField{{0.3, 0.6, 0.9}, {0.0, 1.0, 1.0}, {1.2, 0.5, 0.5}}) {
    const Vector value = interpolate(cube, u, {X})[0];
    EXPECT_NEAR(value[0], X[0] * X[1] * X[2], 1e-14);
    EXPECT_NEAR(value[1], X[0] * X[1], 1e-14);
    EXPECT_NEAR(value[2], 1.0, 1e-14);
  }
  EXPECT_THROW(interpolate(cube, u, {{50.0, 0.0, 0.0}}), InputError);
}

TEST(CoarserMeshes, are_coarser_and_there_once) {
  const auto counts = [](const AnyGenerator& generator) {
    std::vector<int> all;
    for (const auto& entry : element_counts(generator)) {
      all.insert(all.end(), entry.counts.begin(), entry.counts.end());
    }
    return all;
  };
  std::vector<std::vector<int>> found;
  for (const auto& mesh : coarser_meshes(BoxMesh{{1.0, 1.0, 1.0}, {3, 3, 30}})) found.push_back(counts(mesh));
  EXPECT_EQ(found, (std::vector<std::vector<int>>{{2, 2, 30}, {2, 2, 23}, {2, 2, 15}}));
  EXPECT_TRUE(coarser_meshes(BoxMesh{{1.0, 1.0, 1.0}, {1, 1, 1}}).empty());
  EXPECT_EQ(counts_text(BoxMesh{{1.0, 1.0, 1.0}, {3, 3, 30}}), "elements = [3, 3, 30]");
  for (const auto& generator : sample_generators()) {
    const auto all = coarser_meshes(generator);
    EXPECT_FALSE(all.empty());
    for (const auto& mesh : all) {
      EXPECT_LT(generate_mesh(mesh).cells.size(), generate_mesh(generator).cells.size());
      EXPECT_GE(std::ranges::min(counts(mesh)), 1);
    }
  }
}

}  // namespace
}  // namespace sandglass::verification
