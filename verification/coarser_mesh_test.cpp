/// Coarser meshes of one body, and interpolation between them.

#include <gtest/gtest.h>

#include <algorithm>

#include "base/error.hpp"
#include "choice/variations.hpp"
#include "mesh/hexahedron.hpp"
#include "mesh/interpolation.hpp"
#include "support/plain_generators.hpp"
#include "support/random_hexahedra.hpp"
#include "support/scenes.hpp"

namespace sandglass::verification::coarser_mesh_test {
namespace {

/// The value of one element's trilinear form, summed from the shape functions; of nodes, the position.
Vector trilinear_form(const Hexahedron& cell, const NodalField& field, const Vector& xi) {
  Vector value{};
  for (int I = 0; I < 8; ++I) {
    double N = 0.125;
    for (int i = 0; i < 3; ++i) N *= 1.0 + corner_signs(I, i) * xi[index(i)];
    const Vector& at_node = field[index(cell[index(I)])];
    for (std::size_t i = 0; i < 3; ++i) value[i] += N * at_node[i];
  }
  return value;
}

/// Independent values in [-1, 1] at every node: no element's form continues into its neighbours.
NodalField random_field(const Mesh& mesh, RandomGeometry& random) {
  NodalField field(mesh.points.size());
  for (Vector& value : field) {
    for (double& component : value) component = random.uniform(-1.0, 1.0);
  }
  return field;
}

/// Roundoff of a value, for values in [-1, 1]. A position X, summed from eight products, is wrong by 12 half
/// units in the last place of its size, 1.3e-15 |X|. The parent point is wrong by that times 2 / h, and so is
/// the value along each of three axes, along which a trilinear form of such values changes by at most 1:
/// 8e-15 |X| / h. In the meshes here |X| / h is at most 12.
constexpr double roundoff = 1e-13;

/// The value comes from the element that contains the point, also close to its faces, where points are barely
/// outside of the neighbours.
TEST(Interpolation, takes_the_element_that_holds_the_point) {
  RandomGeometry random(19);
  auto generators = plain_generators();
  generators.emplace_back(BeamMesh{.size = {1.0, 0.2, 0.1}, .elements = {6, 2, 2}, .alternating_slant = 0.3});
  for (const auto& generator : generators) {
    SCOPED_TRACE(counts_text(generator));
    const Mesh mesh = generate_mesh(generator);
    const NodalField field = random_field(mesh, random);
    NodalField places, expected;
    for (const Hexahedron& cell : mesh.cells) {
      for (int sample = 0; sample < 10; ++sample) {
        Vector xi{};
        for (double& component : xi) component = random.uniform(-0.99, 0.99);
        places.push_back(trilinear_form(cell, mesh.points, xi));
        expected.push_back(trilinear_form(cell, field, xi));
      }
    }
    const NodalField found = interpolate(mesh, field, places);
    ASSERT_EQ(found.size(), expected.size());
    for (std::size_t n = 0; n < found.size(); ++n) {
      for (std::size_t i = 0; i < 3; ++i) EXPECT_NEAR(found[n][i], expected[n][i], roundoff) << "point " << n;
    }
  }
}

/// Outside the middle of a face by 0.3 of an element's half edge, every other element is farther in parent
/// coordinates.
TEST(Interpolation, continues_the_nearest_element_outside) {
  RandomGeometry random(20);
  const Mesh mesh = box({2.0, 3.0, 4.0}, {2, 3, 4});
  const NodalField field = random_field(mesh, random);
  for (const Hexahedron& cell : mesh.cells) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      for (const double side : {-1.3, 1.3}) {
        Vector xi{};
        for (double& component : xi) component = random.uniform(-0.5, 0.5);
        xi[axis] = side;
        const Vector X = trilinear_form(cell, mesh.points, xi);
        if (X[axis] > 0.0 && X[axis] < 2.0 + static_cast<double>(axis)) continue;  // in another element
        const Vector found = interpolate(mesh, field, {X})[0];
        const Vector expected = trilinear_form(cell, field, xi);
        for (std::size_t i = 0; i < 3; ++i) EXPECT_NEAR(found[i], expected[i], roundoff);
      }
    }
  }
}

/// A body ten thousand of its lengths away: positions lose as many digits, and are still found.
TEST(Interpolation, finds_points_far_from_the_origin) {
  RandomGeometry random(21);
  constexpr double far = 1e4;
  for (const auto& generator : plain_generators()) {
    SCOPED_TRACE(counts_text(generator));
    Mesh mesh = generate_mesh(generator);
    for (Vector& X : mesh.points) {
      for (double& x : X) x += far;
    }
    const NodalField field = random_field(mesh, random);
    for (const Hexahedron& cell : mesh.cells) {
      const Vector xi{random.uniform(-0.9, 0.9), random.uniform(-0.9, 0.9), random.uniform(-0.9, 0.9)};
      const Vector found = interpolate(mesh, field, {trilinear_form(cell, mesh.points, xi)})[0];
      const Vector expected = trilinear_form(cell, field, xi);
      for (std::size_t i = 0; i < 3; ++i) EXPECT_NEAR(found[i], expected[i], far * roundoff);
    }
  }
}

/// Trilinear forms reproduce linear fields and extend them. At the nodes of the finer mesh, some of them
/// outside a coarser one with a curved boundary, the field is linear up to the same roundoff times its
/// gradient.
TEST(Interpolation, gives_linear_fields_exactly_between_meshes_of_one_body) {
  const Tensor<double> H{0.3, -0.2, 0.1, 0.5, 0.7, -0.4, 0.2, 0.9, -0.6};
  for (const auto& generator : plain_generators()) {
    const Mesh fine = generate_mesh(generator);
    for (const auto& coarser : coarser_meshes(generator)) {
      const Mesh coarse = generate_mesh(coarser);
      NodalField u;
      for (const auto& X : coarse.points) u.push_back(linear(H, X));
      const NodalField there = interpolate(coarse, u, fine.points);
      for (std::size_t n = 0; n < fine.points.size(); ++n) {
        const Vector expected = linear(H, fine.points[n]);
        for (std::size_t i = 0; i < 3; ++i) EXPECT_NEAR(there[n][i], expected[i], roundoff);
      }
    }
  }
}

/// Outside a single element its trilinear form is extended, here x y z and x y; distant points are an error.
TEST(Interpolation, refuses_points_far_away) {
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
  for (const auto& generator : plain_generators()) {
    const auto all = coarser_meshes(generator);
    EXPECT_FALSE(all.empty());
    for (const auto& mesh : all) {
      EXPECT_LT(generate_mesh(mesh).cells.size(), generate_mesh(generator).cells.size());
      EXPECT_GE(std::ranges::min(counts(mesh)), 1);
    }
  }
}

}  // namespace
}  // namespace sandglass::verification::coarser_mesh_test
