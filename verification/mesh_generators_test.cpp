/// Generated meshes: counts and volumes of the canonical cases, closed surfaces, positive Jacobians, masses.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>

#include "comparison/mesh_quality.hpp"
#include "element/methods.hpp"
#include "io/case_file.hpp"
#include "mesh/generators.hpp"
#include "mesh/node_set.hpp"
#include "mesh/parts.hpp"
#include "mesh/placed_body.hpp"
#include "mesh/quality.hpp"
#include "mesh/vectors.hpp"
#include "problem/masses.hpp"
#include "support/plain_generators.hpp"
#include "support/scenes.hpp"
#include "support/typed_lists.hpp"

namespace sandglass::verification::mesh_generators_test {
namespace {

Scene canonical(const std::string& name) {
  return read_scene(std::filesystem::path(SANDGLASS_SOURCE) / "cases" / (name + ".toml"));
}

double volume(const Mesh& mesh) {
  double sum = 0.0;
  for (const auto& cell : mesh.cells) sum += mean_gradient(gather(mesh.points, cell)).volume;
  return sum;
}

double smallest_scaled_jacobian(const Mesh& mesh) {
  double smallest = 1.0;
  for (const auto& cell : mesh.cells)
    smallest = std::min(smallest, scaled_jacobian(gather(mesh.points, cell)));
  return smallest;
}

/// The volume inside the boundary faces by the divergence theorem, each bilinear face as the mean of its two
/// triangulations. It is positive only if faces point outward.
double enclosed_volume(const Mesh& mesh) {
  const auto triple = [&](int a, int b, int c) {
    const auto n = cross(mesh.points[index(b)], mesh.points[index(c)]);
    const auto& p = mesh.points[index(a)];
    return p[0] * n[0] + p[1] * n[1] + p[2] * n[2];
  };
  double sum = 0.0;
  for (const auto& [a, b, c, d] : boundary_faces(mesh.cells)) {
    sum += triple(a, b, c) + triple(a, c, d) + triple(a, b, d) + triple(b, c, d);
  }
  return sum / 12.0;
}

/// A closed, consistently oriented surface traverses each edge once in each direction.
void expect_closed(const Mesh& mesh) {
  std::map<std::pair<int, int>, int> directed;
  for (const auto& face : boundary_faces(mesh.cells)) {
    for (std::size_t n = 0; n < 4; ++n) ++directed[{face[n], face[(n + 1) % 4]}];
  }
  for (const auto& [edge, count] : directed) {
    EXPECT_EQ(count, 1);
    EXPECT_TRUE(directed.contains({edge.second, edge.first}));
  }
}

/// Properties of every generated mesh.
void expect_sound(const Mesh& mesh) {
  ASSERT_FALSE(mesh.cells.empty());
  EXPECT_NO_THROW(require_positive_jacobians(mesh));
  for (const auto& cell : mesh.cells) EXPECT_GT(smallest_measure(gather(mesh.points, cell)), 0.0);
  expect_closed(mesh);
  EXPECT_NEAR(enclosed_volume(mesh) / volume(mesh), 1.0, 1e-12);
  std::vector<bool> used(mesh.points.size(), false);
  for (const auto& cell : mesh.cells) {
    for (const int node : cell) used[index(node)] = true;
  }
  EXPECT_EQ(std::count(used.begin(), used.end(), false), 0) << "nodes without elements would have no mass";
}

struct Count {
  const char* name;
  std::size_t nodes;
  std::size_t elements;
};

class CanonicalMeshTest : public ::testing::TestWithParam<Count> {};

TEST_P(CanonicalMeshTest, has_the_published_counts_and_is_sound) {
  const Scene scene = canonical(GetParam().name);
  EXPECT_EQ(scene.mesh.points.size(), GetParam().nodes);
  EXPECT_EQ(scene.mesh.cells.size(), GetParam().elements);
  expect_sound(scene.mesh);
}

INSTANTIATE_TEST_SUITE_P(Cases, CanonicalMeshTest,
                         ::testing::Values(Count{"column", 496, 270},  // the paper, section 3.2
                                           Count{"ellipsoid-indentation", 2535, 2200},  // the paper, 3.1
                                           Count{"ellipsoid-touch", 2535, 2200},
                                           Count{"cylinder-stretch", 6741, 6000},  // TLED paper of 2007
                                           Count{"cylinder-compression", 6741, 6000}),
                         [](const auto& parameter) {
                           std::string name = parameter.param.name;
                           std::replace(name.begin(), name.end(), '-', '_');
                           return name;
                         });

TEST(CanonicalMesh, ellipsoid_has_the_documented_sets_shape_and_volume) {
  const Scene scene = canonical("ellipsoid-indentation");
  EXPECT_EQ(scene.sets.at("support").size(), 141U);
  EXPECT_EQ(scene.sets.at("indenter").size(), 65U);
  EXPECT_GE(smallest_scaled_jacobian(scene.mesh), 0.6);
  EXPECT_NEAR(volume(scene.mesh), 2.81777e-3, 5e-9);                                  // to the digits given
  EXPECT_LT(volume(scene.mesh), 4.0 / 3.0 * std::numbers::pi * 0.10 * 0.085 * 0.08);  // inscribed
  for (const int node : scene.sets.at("midline")) EXPECT_NEAR(scene.mesh.points[index(node)][1], 0.0, 1e-12);
  const auto on_boundary = boundary_nodes(scene.mesh);
  for (std::size_t n = 0; n < on_boundary.size(); ++n) {
    const auto& [x, y, z] = scene.mesh.points[n];
    const double radius = std::hypot(x / 0.10, y / 0.085, z / 0.08);
    if (on_boundary[n]) {
      EXPECT_NEAR(radius, 1.0, 1e-12);
    } else {
      EXPECT_LT(radius, 0.999);
    }
  }
}

TEST(CanonicalMesh, cylinder_has_the_volume_of_its_polygon) {
  const Scene scene = canonical("cylinder-stretch");
  // 40 equal sides: 4 core edges of 10, whose ends are at equal angles due to the map's tangent.
  const double polygon = 0.5 * 40 * 0.05 * 0.05 * std::sin(2 * std::numbers::pi / 40);
  EXPECT_NEAR(volume(scene.mesh) / (0.1 * polygon), 1.0, 1e-12);
  EXPECT_EQ(scene.sets.at("bottom").size(), 321U);  // 6741 nodes in 21 planes
  EXPECT_EQ(scene.sets.at("top").size(), 321U);
  EXPECT_EQ(scene.sets.at("generator_line").size(), 21U);
}

TEST(CanonicalMesh, column_has_its_volume_and_sets) {
  const Scene scene = canonical("column");
  EXPECT_NEAR(volume(scene.mesh), 0.01, 1e-15);
  EXPECT_EQ(scene.sets.at("bottom").size(), 16U);
  EXPECT_EQ(scene.sets.at("top").size(), 16U);
  EXPECT_EQ(scene.sets.at("edge").size(), 31U);
  EXPECT_EQ(smallest_scaled_jacobian(scene.mesh), 1.0);
}

/// Land's mesh: elements in the given number of layers, surfaces on their ellipsoids, the rim in one plane.
TEST(CanonicalMesh, ventricle_lies_between_its_ellipsoids) {
  const Scene scene =
      read_scene(read_cases(std::filesystem::path(SANDGLASS_SOURCE) / "cases" / "ventricle.toml").front());
  ASSERT_EQ(scene.mesh.cells.size(), 504U);
  for (const auto& cell : scene.mesh.cells) {
    EXPECT_GT(OnePoint::precompute(gather(scene.mesh.points, cell)).V, 0.0);
  }
  const auto on = [](const Vector& X, double a, double c) {
    return std::abs((X[0] * X[0] + X[1] * X[1]) / (a * a) + X[2] * X[2] / (c * c) - 1.0) < 1e-12;
  };
  std::size_t inside = 0, outside = 0, rim = 0;
  for (const Vector& X : scene.mesh.points) {
    inside += on(X, 7.0, 17.0);
    outside += on(X, 10.0, 20.0);
    rim += std::abs(X[2] - 5.0) < 1e-12;
  }
  const std::size_t surface = scene.mesh.points.size() / 3;
  EXPECT_EQ(inside, surface);
  EXPECT_EQ(outside, surface);
  EXPECT_EQ(rim, 3U * 24U);
  EXPECT_EQ(scene.sets.at("inside").size(), surface);
  EXPECT_EQ(scene.sets.at("rim").size(), rim);
  EXPECT_EQ(scene.sets.at("apex").size(), 1U);
  EXPECT_EQ(faces_within(scene.boundary, scene.sets.at("inside")).size(), 252U);
}

TEST(Beams, leaning_elements_keep_ends_and_volume) {
  const Mesh upright = BeamMesh{{6.0, 0.2, 0.1}, {6, 1, 1}}.build();
  for (const auto& [slant, alternating] : {std::pair{1.0, 0.0}, std::pair{0.0, 1.0}}) {
    const Mesh mesh = BeamMesh{{6.0, 0.2, 0.1}, {6, 1, 1}, slant, alternating}.build();
    expect_sound(mesh);
    EXPECT_NEAR(volume(mesh), 6.0 * 0.2 * 0.1, 1e-15);
    for (std::size_t n = 0; n < mesh.points.size(); ++n) {
      const Vector& X = upright.points[n];
      const bool end = X[0] == 0.0 || X[0] == 6.0;
      const double sign = alternating > 0.0 && std::lround(X[0]) % 2 == 0 ? -1.0 : 1.0;
      const double lean = end ? 0.0 : sign * X[1];  // 45 degrees
      EXPECT_NEAR(mesh.points[n][0], X[0] + lean, 1e-15);
      EXPECT_EQ(mesh.points[n][1], X[1]);
      EXPECT_EQ(mesh.points[n][2], X[2]);
    }
  }
}

/// The width of a section points along y at the root and along z at the tip, a quarter of a turn away; it
/// turns evenly in between.
TEST(Beams, twisted_one_turns_its_section_about_x) {
  const Mesh mesh = BeamMesh{{12.0, 1.1, 0.32}, {12, 2, 1}, 0.0, 0.0, 90.0}.build();
  expect_sound(mesh);
  const Mesh straight = BeamMesh{{12.0, 1.1, 0.32}, {12, 2, 1}}.build();
  for (std::size_t n = 0; n < mesh.points.size(); ++n) {
    const auto& [x, y, z] = straight.points[n];
    const double turn = x / 12.0 * std::numbers::pi / 2;
    EXPECT_NEAR(mesh.points[n][0], x, 1e-15);
    EXPECT_NEAR(mesh.points[n][1], std::cos(turn) * y - std::sin(turn) * z, 1e-15);
    EXPECT_NEAR(mesh.points[n][2], std::sin(turn) * y + std::cos(turn) * z, 1e-15);
  }
}

/// Six chords of 15 degrees: the volume of their trapezoids, between radii 4.12 and 4.32.
TEST(Beams, curved_one_follows_its_arc) {
  const Mesh mesh = CurvedBeamMesh{4.12, 0.2, 0.1, 90.0, {6, 1, 1}}.build();
  expect_sound(mesh);
  const double exact = 6 * 0.5 * std::sin(std::numbers::pi / 12) * (4.32 * 4.32 - 4.12 * 4.12) * 0.1;
  EXPECT_NEAR(volume(mesh) / exact, 1.0, 1e-13);
  for (const auto& [x, y, z] : mesh.points) {
    const double r = std::hypot(x, y);
    EXPECT_LT(std::min(std::abs(r - 4.12), std::abs(r - 4.32)), 1e-14);
  }
  EXPECT_EQ(mesh.points.front(), (Vector{0.0, 4.12, 0.0}));  // starts on x = 0
  EXPECT_NEAR(mesh.points.back()[0], 4.32, 1e-15);           // ends on y = 0
  EXPECT_NEAR(mesh.points.back()[1], 0.0, 1e-15);
}

TEST(TaperedPanel, has_the_area_of_cooks_membrane) {
  const Mesh mesh = TaperedPanelMesh{48.0, {0.0, 44.0}, {44.0, 60.0}, 1.0, {4, 4, 1}}.build();
  expect_sound(mesh);
  EXPECT_NEAR(volume(mesh), 48.0 * (44.0 + 16.0) / 2, 1e-10);
  const NodeSetRule middle{"middle", false, {{Interval{48.0, 48.0}, Interval{52.0, 52.0}, {}}}, {}};
  EXPECT_EQ(select_nodes(mesh, boundary_nodes(mesh), middle).size(), 2U);
}

/// MacNeal and Harder's hemisphere. The nodes lie on two spheres. Its volume is below that between them,
/// (angle / 3) (R^3 - r^3) cos(hole), by at most a fraction of a^2 / 3, where a is the angle of an element:
/// chords of arcs of a cut a fraction of a^2 / 6 off a circle, in two directions.
TEST(SphericalShell, lies_between_two_spheres) {
  const double a = std::numbers::pi / 2 / 16;
  const Mesh mesh = SphericalShellMesh{10.0, 0.04, 18.0, 90.0, {16, 16, 1}}.build();
  expect_sound(mesh);
  for (const auto& [x, y, z] : mesh.points) {
    const double r = std::sqrt(x * x + y * y + z * z);
    EXPECT_NEAR(std::abs(r - 10.0), 0.02, 1e-14);
    EXPECT_LE(z, r * std::cos(std::numbers::pi / 10) + 1e-14);
    EXPECT_GE(std::min({x, y, z}), -1e-15);
  }
  const double exact =
      std::numbers::pi / 6 * (std::pow(10.02, 3) - std::pow(9.98, 3)) * std::cos(std::numbers::pi / 10);
  EXPECT_LT(volume(mesh), exact);
  EXPECT_GT(volume(mesh), exact * (1.0 - a * a / 3));
  const NodeSetRule pinched{"a", false, {{{}, Interval{0.0, 0.0}, Interval{0.0, 0.0}}}, {}};
  EXPECT_EQ(select_nodes(mesh, boundary_nodes(mesh), pinched).size(), 2U);
}

/// The map of the ball onto itself takes the centre to the focus f and the sphere to itself. It is conformal:
/// distances change by the root of the scales (1 - f^2) / (1 + 2 f . x + f^2 x^2) at both ends, which is
/// (1 - f) / (1 + f) at the pole. Then the axes scale the ball.
TEST(EllipsoidMesh, is_finer_near_its_focus) {
  const std::array<double, 3> semi_axes{3.0, 2.0, 5.0};
  const EllipsoidMesh plain{{1.0, 1.0, 1.0}, 8, 2};
  EllipsoidMesh focused{semi_axes, 8, 2};
  focused.focus = {0.0, 0.6, 0.0};
  const Vector pole{0.0, 1.0, 0.0};
  const auto scale = [](const Vector& x) { return 0.64 / (1.0 + 1.2 * x[1] + 0.36 * dot(x, x)); };
  const Mesh ball = plain.build(), mesh = focused.build();
  EXPECT_EQ(mesh.cells, ball.cells);
  const auto outside = boundary_nodes(ball);
  const auto back = [&](std::size_t n) {
    const Vector& X = mesh.points[n];
    return Vector{X[0] / semi_axes[0], X[1] / semi_axes[1], X[2] / semi_axes[2]};
  };
  for (std::size_t n = 0; n < outside.size(); ++n) {
    const Vector& x = ball.points[n];
    const double h = distance(x, pole);
    EXPECT_TRUE(!outside[n] || std::abs(length(back(n)) - 1.0) < 1e-14);
    EXPECT_TRUE(length(x) > 1e-14 || distance(back(n), focused.focus) < 1e-14);
    EXPECT_NEAR(distance(back(n), pole), h * std::sqrt(0.25 * scale(x)), 1e-14);
  }
  EXPECT_GT(smallest_scaled_jacobian(mesh), 0.25);
}

template <class Generator>
class GeneratorTest : public ::testing::Test {};

TYPED_TEST_SUITE(GeneratorTest, GeneratorTypes, EntryName);

TYPED_TEST(GeneratorTest, makes_sound_meshes) {
  expect_sound(plain_generator<TypeParam>().build());
}

TYPED_TEST(GeneratorTest, makes_the_same_mesh_again) {
  const auto generator = plain_generator<TypeParam>();
  const Mesh once = generator.build();
  const Mesh again = generator.build();
  EXPECT_EQ(once.points, again.points);
  EXPECT_EQ(once.cells, again.cells);
}

/// Boxes of different sizes; a third of a turn about the diagonal of space takes x to y, y to z, z to x.
TEST(PlacedBodies, are_turned_then_moved_and_have_sets) {
  const double third = 120.0 / std::sqrt(3.0);
  const auto [mesh, sets, element_sets] =
      build({{.label = "b", .generator = BoxMesh{{1.0, 2.0, 3.0}, {1, 1, 1}}},
             {.label = "a",
              .turn = {third, third, third},
              .offset = {0.5, 0.25, -1.0},
              .generator = BoxMesh{{1.0, 2.0, 3.0}, {1, 2, 1}}}});
  EXPECT_EQ(sets, (NodeSets{{"a", {8, 9, 10, 11, 12, 13, 14, 15, 16, 17, 18, 19}},
                            {"b", {0, 1, 2, 3, 4, 5, 6, 7}}}));
  EXPECT_EQ(element_sets, (ElementSets{{"a", {1, 2}}, {"b", {0}}}));
  EXPECT_EQ(parts_of_nodes(mesh, {}),
            (std::vector<int>{0, 0, 0, 0, 0, 0, 0, 0, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1}));
  const Mesh plain = BoxMesh{{1.0, 2.0, 3.0}, {1, 2, 1}}.build();
  for (std::size_t n = 0; n < plain.points.size(); ++n) {
    const Vector& X = plain.points[n];
    EXPECT_LT(distance(mesh.points[8 + n], {X[2] + 0.5, X[0] + 0.25, X[1] - 1.0}), 1e-14);
  }
  EXPECT_NEAR(volume(mesh), 12.0, 1e-13);
}

/// A node has an eighth of the mass of each of its elements, here of lengths 1 and 3.
TEST(Masses, belong_to_the_elements_around) {
  Mesh mesh = box({2.0, 1.0, 1.0}, {2, 1, 1});
  for (auto& X : mesh.points) X[0] = X[0] < 1.5 ? X[0] : 4.0;
  const auto masses = lumped_masses(mesh, element_masses(mesh, {{{NeoHookean{}, 80.0}}}));
  for (std::size_t n = 0; n < masses.size(); ++n) {
    const double x = mesh.points[n][0];
    EXPECT_NEAR(masses[n], x < 0.5 ? 10.0 : x < 2.0 ? 40.0 : 30.0, 1e-13) << "x = " << x;
  }
}

/// Lumped masses: an eighth of rho V at each node, without loss.
TEST(Masses, sum_to_density_times_volume) {
  for (const char* name : {"column", "ellipsoid-touch", "cylinder-stretch"}) {
    const Scene scene = canonical(name);
    const Model model(scene, {"tl-none", {}});
    double sum = 0.0;
    for (const double mass : model.masses()) {
      EXPECT_GT(mass, 0.0);
      sum += mass;
    }
    EXPECT_NEAR(sum / (1000.0 * enclosed_volume(scene.mesh)), 1.0, 1e-12) << name;
  }
}

}  // namespace
}  // namespace sandglass::verification::mesh_generators_test
