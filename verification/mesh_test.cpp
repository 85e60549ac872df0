/// Meshes: node sets, parts, hashes, the quality of elements, overlaps.

#include "mesh/mesh.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <random>

#include "base/error.hpp"
#include "comparison/mesh_quality.hpp"
#include "mesh/hash.hpp"
#include "mesh/hexahedron.hpp"
#include "mesh/interpolation.hpp"
#include "mesh/node_set.hpp"
#include "mesh/parts.hpp"
#include "mesh/quality.hpp"
#include "support/scenes.hpp"

namespace sandglass::verification::mesh_test {
namespace {

/// Rules do not depend on a unit of length: in a body of a millionth of the size, scaled rules select the
/// same sets, also in corner cases, where nodes lie on the edge of a rule up to roundoff.
TEST(NodeSets, do_not_depend_on_the_unit_of_length) {
  std::vector<std::vector<int>> found;
  for (const double size : {1e-6, 1e-3, 1.0, 1e3, 1e6}) {
    const Mesh mesh = EllipsoidMesh{{1.0 * size, 0.9 * size, 0.8 * size}, 4, 2}.build();
    const NodeSetRule band{"band", true, {{{}, Interval{-0.1 * size, 0.3 * size}, {}}}, {}};
    const NodeSetRule core{"core", false, {}, CylinderRegion{2, {0.1 * size, 0.0}, {0.5 * size, 0.4 * size}}};
    const NodeSetRule plane{"plane", false, {{{}, {}, Interval{0.0, 0.0}}}, {}};
    const auto on_boundary = boundary_nodes(mesh);
    for (const auto& rule : {band, core, plane}) found.push_back(select_nodes(mesh, on_boundary, rule));
  }
  for (std::size_t n = 0; n < found.size(); ++n) {
    EXPECT_FALSE(found[n].empty());
    EXPECT_EQ(found[n], found[n % 3]);
  }
}

/// Rules tolerate coordinates rounded to six digits, 5e-6 of the largest coordinate: nodes off a plane by a
/// little less are on it, by a little more are not, in a body of a micrometre as in one of a thousand
/// kilometres.
TEST(NodeSets, forgive_a_share_of_the_body_and_no_length) {
  for (const double size : {1e-6, 1.0, 1e6}) {
    Mesh mesh = box({size, size, size}, {1, 1, 1});
    const std::array<double, 4> off{4.9e-6, -4.9e-6, 5.1e-6, -5.1e-6};  // of nodes 4 to 7, the upper ones
    for (std::size_t n = 0; n < 4; ++n) mesh.points[4 + n][2] *= 1.0 + off[n];
    const NodeSetRule top{"top", false, {{{}, {}, Interval{size, size}}}, {}};
    EXPECT_EQ(select_nodes(mesh, boundary_nodes(mesh), top), (std::vector<int>{4, 5})) << "size " << size;
  }
}

/// The tolerance is at most a thousandth of the shortest edge, for planes that are close together or bodies
/// far from the origin.
TEST(NodeSets, keep_planes_of_nodes_apart) {
  Mesh mesh = box({1.0, 1.0, 1.0}, {1, 1, 2});
  for (Vector& X : mesh.points) X[2] = X[2] == 0.5 ? 1.0 - 1e-6 : X[2];
  const NodeSetRule top{"top", false, {{{}, {}, Interval{1.0, 1.0}}}, {}};
  EXPECT_EQ(select_nodes(mesh, boundary_nodes(mesh), top).size(), 4U);
  Mesh far = box({1.0, 1.0, 1.0}, {1, 1, 2});
  for (Vector& X : far.points) X[2] += 1e6;
  const NodeSetRule middle{"middle", false, {{{}, {}, Interval{1e6 + 0.5 - 9e-4, 1e6 + 0.5 - 9e-4}}}, {}};
  EXPECT_EQ(select_nodes(far, boundary_nodes(far), middle).size(), 0U);
}

/// The definition of the elliptic cylinder, along each axis, with the other coordinates in the order of the
/// axes.
TEST(NodeSets, cylinder_selects_what_lies_inside) {
  const Mesh mesh = box({1.0, 1.0, 1.0}, {6, 6, 6});
  const auto on_boundary = boundary_nodes(mesh);
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const std::size_t first = axis == 0 ? 1 : 0;
    const std::size_t second = axis == 2 ? 1 : 2;
    const NodeSetRule rule{"rod", true, {}, CylinderRegion{static_cast<int>(axis), {0.4, 0.7}, {0.31, 0.22}}};
    const auto inside = [&](const Vector& X) {
      const double a = (X[first] - 0.4) / 0.31;
      const double b = (X[second] - 0.7) / 0.22;
      const bool surface = std::any_of(X.begin(), X.end(), [](double x) { return x == 0.0 || x == 1.0; });
      return surface && a * a + b * b < 1.0;
    };
    EXPECT_EQ(select_nodes(mesh, on_boundary, rule), nodes_where(mesh.points, inside)) << "axis " << axis;
  }
}

TEST(NodeSets, ellipsoid_selects_what_lies_inside) {
  const Mesh mesh = box({1.0, 1.0, 1.0}, {6, 6, 6});
  const NodeSetRule rule{"egg", false, {}, {}, EllipsoidRegion{{0.4, 0.7, 0.1}, {0.31, 0.22, 0.54}}};
  const auto inside = [](const Vector& X) {
    const double a = (X[0] - 0.4) / 0.31, b = (X[1] - 0.7) / 0.22, c = (X[2] - 0.1) / 0.54;
    return a * a + b * b + c * c < 1.0;
  };
  EXPECT_EQ(select_nodes(mesh, boundary_nodes(mesh), rule), nodes_where(mesh.points, inside));
}

/// Two bars side by side, with an isolated node between them: nodes are in order, and the second bar comes
/// first because its nodes do. A tie of one node joins them, as does a node shared by two cells.
TEST(Parts, are_joined_by_nodes_and_ties) {
  Mesh mesh = box({1.0, 1.0, 2.0}, {1, 1, 2});
  const Mesh other = mesh;
  const int shift = static_cast<int>(mesh.points.size()) + 1;
  mesh.points.push_back({1.5, 0.0, 0.0});
  for (const Vector& X : other.points) mesh.points.push_back({X[0] + 2.0, X[1], X[2]});
  for (auto cell : other.cells) {
    for (int& node : cell) node += shift;
    mesh.cells.insert(mesh.cells.begin(), cell);
  }
  const std::vector<int> parts = parts_of_nodes(mesh, {});
  for (int n = 0; n < static_cast<int>(parts.size()); ++n)
    EXPECT_EQ(parts[at(n)], n < shift - 1 ? 0 : n == shift - 1 ? -1 : 1) << n;
  EXPECT_EQ(number_of_parts(mesh, {}), 2);
  EXPECT_EQ(number_of_parts(mesh, {{shift + 3, {{2, 0.25}, {5, 0.75}}}}), 1);
  EXPECT_EQ(number_of_parts({}, {}), 0);
}

TEST(MeshHash, sees_points_cells_and_sets_but_not_the_last_bits) {
  Mesh mesh = box({0.1, 0.2, 0.3}, {2, 2, 2});
  const NodeSets sets{{"a", {1, 2}}};
  const std::string hash = mesh_hash(mesh, sets);
  Mesh nudged = mesh;
  for (auto& point : nudged.points) point[1] *= 1.0 + 1e-15;
  EXPECT_EQ(mesh_hash(nudged, sets), hash);
  nudged.points[4][0] += 1e-5;
  EXPECT_NE(mesh_hash(nudged, sets), hash);
  Mesh renumbered = mesh;
  std::swap(renumbered.cells[0], renumbered.cells[1]);
  EXPECT_NE(mesh_hash(renumbered, sets), hash);
  EXPECT_NE(mesh_hash(mesh, {{"a", {1, 3}}}), hash);
  EXPECT_NE(mesh_hash(mesh, {{"b", {1, 2}}}), hash);
}

TEST(MeshQuality, names_the_first_ten_inverted_elements) {
  Mesh mesh = box({12.0, 1.0, 1.0}, {12, 1, 1});
  for (auto& cell : mesh.cells) {
    for (std::size_t n = 0; n < 4; ++n) std::swap(cell[n], cell[n + 4]);  // bottom and top exchanged
  }
  try {
    require_positive_jacobians(mesh);
    FAIL() << "inverted elements were accepted";
  } catch (const InputError& error) {
    const std::string text = error.what();
    EXPECT_NE(text.find("12 of 12"), std::string::npos) << text;
    EXPECT_NE(text.find("element 9: centre (9.5, 0.5, 0.5), det J = -0.125"), std::string::npos) << text;
    EXPECT_EQ(text.find("element 10"), std::string::npos) << text;
  }
}

/// Skewed cubes: their scaled Jacobians are the cosines, at all corners. The last is inside out.
TEST(MeshQuality, table_counts_all_and_shows_the_ten_worst) {
  const std::vector<double> cosines{1.0,  0.95, 0.91, 0.85, 0.75, 0.75, 0.65,
                                    0.55, 0.35, 0.25, 0.15, 0.05, -0.5};
  Mesh mesh;
  for (const double c : cosines) {
    const auto first = static_cast<int>(mesh.points.size());
    for (auto [x, y, z] : box({1.0, 1.0, 1.0}, {1, 1, 1}).points) {
      mesh.points.push_back({x + z * std::sqrt(1.0 - c * c), y + 3.0 * static_cast<double>(first), z * c});
    }
    mesh.cells.push_back(box({1.0, 1.0, 1.0}, {1, 1, 1}).cells[0]);
    for (int& node : mesh.cells.back()) node += first;
  }
  const QualityTable table = quality_table(mesh);
  EXPECT_NEAR(table.smallest, -0.5, 1e-15);
  EXPECT_NEAR(table.largest, 1.0, 1e-15);
  EXPECT_EQ(table.counts, (std::array<int, 11>{1, 1, 1, 1, 1, 0, 1, 1, 2, 1, 3}));
  ASSERT_EQ(table.worst.size(), 10U);
  const std::array<std::size_t, 10> order{12, 11, 10, 9, 8, 7, 6, 4, 5, 3};  // equal ones by number
  for (std::size_t i = 0; i < 10; ++i) {
    EXPECT_NEAR(table.worst[i].scaled_jacobian, cosines[order[i]], 1e-15);
    EXPECT_EQ(table.worst[i].number, order[i]);
  }
  EXPECT_NEAR(table.worst[0].centre[1], 0.5 + 3.0 * 8 * 12, 1e-12);
  EXPECT_NEAR(table.worst[0].centre[2], -0.25, 1e-15);
}

/// A unit cube with one corner moved towards the opposite one, by `t` along each edge.
NodalVectors<double> dented_cube(int corner, double t) {
  NodalVectors<double> X = 0.5 * corner_signs;
  for (int i = 0; i < 3; ++i) X(corner, i) -= t * corner_signs(corner, i);
  return X;
}

/// Let n be the products of 1 - s over pairs of the distances s from the dented corner along the cube's
/// edges; then det F = 1 - t (n1 + n2 + n3). At the corner all n are 1, and its edges have the length sqrt((1
/// - t)^2 + 2 t^2); at the Gauss point next to it n = (1 + 1/sqrt(3))^2 / 4. Every corner and every point is
/// the worst of one cube.
TEST(MeshQuality, every_corner_and_gauss_point_counts) {
  for (int corner = 0; corner < 8; ++corner) {
    const double edge = std::sqrt(0.75 * 0.75 + 2 * 0.25 * 0.25);
    EXPECT_NEAR(scaled_jacobian(dented_cube(corner, 0.25)), 0.25 / (edge * edge * edge), 1e-15) << corner;
    const double n = std::pow(1.0 + 1.0 / std::sqrt(3.0), 2) / 4;
    const double expected = (1.0 - 3 * 0.6 * n) / 8;
    EXPECT_LT(expected, 0.0);
    EXPECT_NEAR(smallest_measure(dented_cube(corner, 0.6)), expected, 1e-15) << corner;
  }
}

/// Two wedges whose edges cross anywhere, at any angle, each one element: they overlap if one edge is deeper
/// in the other wedge than a share of half its height, to 1 %. No node is within the other wedge.
TEST(Overlaps, are_found_where_edges_cross) {
  std::mt19937 random(3);
  const auto between = [&](double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(random);
  };
  constexpr double share = 0.3;
  for (int scene = 0; scene < 300; ++scene) {
    const double tip = between(0.001, 0.02), base = between(0.02, 0.3);  // half widths; height 1, length 2
    const double least = 0.5 * share,
                 depth = scene % 2 ? between(1.01 * least, 0.8) : between(0.0, 0.99 * least);
    const double angle = between(0.3, 2.8), shift = between(-0.5, 0.5);
    Mesh mesh;
    for (const bool upper : {false, true}) {
      const auto first = static_cast<int>(mesh.points.size());
      for (int I = 0; I < corner_signs.rows; ++I) {
        const double half = corner_signs(I, 2) > 0.0 ? tip : base, x = half * corner_signs(I, 0),
                     y = corner_signs(I, 1) + (upper ? 0.0 : shift), z = 0.5 * (corner_signs(I, 2) - 1.0);
        if (upper) {  // upside down, turned about the axis z
          mesh.points.push_back({std::cos(angle) * x + std::sin(angle) * y,
                                 std::sin(angle) * x - std::cos(angle) * y, -z - depth});
        } else {
          mesh.points.push_back({x, y, z});
        }
      }
      Hexahedron cell;
      std::iota(cell.begin(), cell.end(), first);
      mesh.cells.push_back(cell);
    }
    std::vector<int> nodes(mesh.points.size());
    std::iota(nodes.begin(), nodes.end(), 0);
    EXPECT_EQ(!overlaps(mesh.points, mesh.cells, nodes, share, share).empty(), scene % 2 == 1)
        << "depth " << depth << ", tip " << tip << ", base " << base << ", angle " << angle;
    EXPECT_TRUE(
        overlaps(mesh.points, mesh.cells, points_within(mesh.points, mesh.cells, nodes, 1e-3)).empty());
  }
}

}  // namespace
}  // namespace sandglass::verification::mesh_test
