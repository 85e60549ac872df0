/// Rigid obstacles: their geometry, forces, potential and stiffness; wrong input. Exact answers.

#include <gtest/gtest.h>

#include <numeric>

#include "forces/contact_force.hpp"
#include "forces/triangle_surface.hpp"
#include "io/case_file.hpp"
#include "solve/relaxation.hpp"
#include "solve/sleep.hpp"
#include "support/case_text.hpp"
#include "support/obstacles.hpp"
#include "support/random_hexahedra.hpp"
#include "support/temporary_folder.hpp"

namespace sandglass::verification::contact_test {
namespace {

/// Obstacles of every shape, seen from both sides, that the origin touches or is a little inside of.
std::vector<Obstacle> obstacles_at_origin() {
  using Shape = Obstacle::Shape;
  std::vector<Obstacle> all{
      {.shape = Shape::plane, .point = {0.1, 0.1, 0.05}, .normal = {1.0, 2.0, 2.0}},
      {.shape = Shape::sphere, .point = {0.6, 0.0, 0.8}, .radius = 1.1},
      {.shape = Shape::capsule, .point = {1.0, 0.5, 0.0}, .end = {-1.0, 0.5, 0.2}, .radius = 0.6},
      {.shape = Shape::capsule, .point = {1.0, 0.5, 0.3}, .end = {3.0, 0.5, 0.2}, .radius = 1.3},
      {.shape = Shape::cylinder, .point = {1.0, 0.5, 0.0}, .end = {2.0, 0.5, 0.2}, .radius = 0.6},
      {.shape = Shape::box, .point = {1.0, 0.2, 0.1}, .half_sizes = {1.1, 2.0, 3.0}}};
  for (std::size_t k = 1; k < 6; ++k) {  // the same from within
    all.push_back(all[k]);
    all.back().inside = true;
    all.back().radius *= 0.8;
    for (double& half : all.back().half_sizes) half *= 0.85;
  }
  for (Obstacle& one : all) {
    one.label = "tool";
    one.set = "all";
    one.displacement = {0.02, 0.01, -0.03};
    one.method = Obstacle::Method::penalty;
  }
  return all;
}

/// A node of which the neighbourhood is pressed by an obstacle: a cube of one element around the origin.
struct Touched {
  Mesh mesh = box({0.2, 0.2, 0.2}, {1, 1, 1});
  std::vector<Quadrilateral> boundary = boundary_faces(mesh.cells);
  NodeSets sets{{"all", {0, 1, 2, 3, 4, 5, 6, 7}}};
  std::vector<double> masses = std::vector<double>(8, 0.125);
  std::vector<int> places = std::vector<int>(8);
  std::vector<double> factors;
  std::shared_ptr<const BodyForce> force;
  const ContactForce* contact;

  /// `away` (m) keeps the undeformed body out of the obstacle.
  explicit Touched(const Obstacle& obstacle, const Vector& away) {
    for (Vector& X : mesh.points) {
      for (std::size_t i = 0; i < 3; ++i) X[i] += away[i] - 0.1;
    }
    std::iota(places.begin(), places.end(), 0);
    ForceResolver resolver{"a.toml", mesh.points, boundary, sets, masses};
    resolver.cells = mesh.cells;
    resolver.young_moduli = {1000.0};
    obstacle.resolve(resolver);
    force = at_rest(resolver.all()).back();
    contact = contacts_of({force}).front();
    for (const LoadCurve& curve : resolver.curves) factors.push_back(curve.at(0.0, 1.0));
  }

  NodalRows at_nodes(const Rows<double>& rows) const { return {rows.data(), places}; }
  Rows<double> forces(const Rows<double>& u) const {
    Rows<double> sum(8), memory(contact->memory());
    contact->add_contact(factors, at_nodes(u), memory.data(), {sum.data(), places});
    return sum;
  }
  double potential(const Rows<double>& u) const {
    double sum = 0.0;
    force->add_potential(factors, at_nodes(u), sum);
    return sum;
  }
};

/// Displacements that bring the cube back to the origin, at random within 2 cm.
Rows<double> back_again(const Vector& away, RandomGeometry& random) {
  Rows<double> u(8);
  for (Row<double>& row : u) {
    for (std::size_t i = 0; i < 3; ++i) row[i] = -away[i] + 0.02 * random.uniform(-1.0, 1.0);
  }
  return u;
}

/// Where the undeformed body may be: far along the normal at the origin, or for cavities near their middle.
Vector start_of(const Obstacle& obstacle) {
  if (obstacle.shape == Obstacle::Shape::plane) return {1.0, 2.0, 2.0};
  if (!obstacle.inside) return {-3.0, -3.0, -3.0};
  Vector middle = obstacle.point;
  if (obstacle.shape == Obstacle::Shape::capsule) {
    for (std::size_t i = 0; i < 3; ++i) middle[i] += 0.3 * (obstacle.end[i] - obstacle.point[i]);
  }
  return middle;
}

/// The nearest point lies on the surface, and the normal there is along the way to it. Points are near the
/// surface, far outside, and inside, where the nearest point may be far.
TEST(Contact, distance_from_an_ellipsoid_is_to_the_nearest_point) {
  const EllipsoidShape shape{{0.1, -0.2, 0.3}, {0.10, 0.07, 0.08}};
  RandomGeometry random(7);
  for (int trial = 0; trial < 3000; ++trial) {
    Vector from{}, at_surface{};
    for (std::size_t i = 0; i < 3; ++i) {
      from[i] = random.uniform(-0.15, 0.15);
      at_surface[i] = from[i] / shape.semi_axes[i];
    }
    const double factor = 1.0 + random.uniform(-1e-4, 1e-4);
    for (std::size_t i = 0; trial % 2 == 0 && i < 3; ++i) from[i] *= factor / length(at_surface);
    const Gap gap = shape.at(sum(shape.centre, 1.0, from));
    const Vector nearest = sum(from, -gap.distance, gap.normal);
    Vector scaled{}, gradient{};
    for (std::size_t i = 0; i < 3; ++i) {
      scaled[i] = nearest[i] / shape.semi_axes[i];
      gradient[i] = scaled[i] / shape.semi_axes[i];
    }
    EXPECT_NEAR(length(scaled), 1.0, 1e-12);
    EXPECT_NEAR(dot(gradient, gap.normal), length(gradient), 1e-12 * length(gradient));
    for (std::size_t i = 0; i < 3; ++i) EXPECT_GE(nearest[i] * from[i], 0.0);  // not the farthest
  }
}

/// Forces are minus the derivative of the potential: for every shape, from both sides. The stiffness along
/// the normal is the derivative of the force. Differences over h of functions that bend within centimetres
/// are accurate to h^2 times 1/cm^2.
TEST(Contact, derives_from_its_potential) {
  RandomGeometry random(5);
  for (const Obstacle& obstacle : obstacles_at_origin()) {
    const Vector away = start_of(obstacle);
    const Touched body(obstacle, away);
    int pressed = 0;
    for (int trial = 0; trial < 20; ++trial) {
      Rows<double> u = back_again(away, random);
      const Rows<double> forces = body.forces(u);
      std::vector<Spring> springs;
      const Rows<double> memory(body.contact->memory());
      body.contact->add_springs(body.factors, body.at_nodes(u), memory.data(), springs);
      Rows<float> roots(8);
      for (const Spring& spring : springs) roots[at(body.places[at(spring.nodes[0])])] = spring.root;
      for (std::size_t n = 0; n < 8; ++n) {
        Vector from_potential{};
        const double h = 1e-6;
        for (std::size_t i = 0; i < 3; ++i) {
          const double there = u[n][i];
          u[n][i] = there + h;
          const double up = body.potential(u);
          u[n][i] = there - h;
          from_potential[i] = (body.potential(u) - up) / (2.0 * h);
          u[n][i] = there;
        }
        const Vector force{forces[n][0], forces[n][1], forces[n][2]},
            root{roots[n][0], roots[n][1], roots[n][2]};
        const double size = length(force), k = dot(root, root);
        EXPECT_LT(distance(force, from_potential), 1e-4 * size + 1e-6);
        if (size < 1e-3) continue;
        ++pressed;
        const Vector normal = direction_of(root, length(root));
        EXPECT_NEAR(dot(force, normal), size, 1e-6 * size);
        for (std::size_t i = 0; i < 3; ++i) u[n][i] += h * normal[i];
        const Rows<double> moved = body.forces(u);
        for (std::size_t i = 0; i < 3; ++i) {
          EXPECT_NEAR((forces[n][i] - moved[n][i]) / h, k * normal[i], 1e-4 * k);
          u[n][i] -= h * normal[i];
        }
      }
    }
    EXPECT_GT(pressed, 10) << static_cast<int>(obstacle.shape) << obstacle.inside;
  }
}

/// Distances are exact on the surface and beyond: of a plane, along the axis and at the ends of a capsule,
/// and of the faces, edges and corners of a box.
TEST(Contact, measures_distances) {
  const auto expect = [](const auto& shape, const Vector& x, double d, const Vector& normal) {
    const Gap gap = shape.at(x);
    EXPECT_NEAR(gap.distance, d, 1e-14);
    EXPECT_LT(distance(gap.normal, normal), 1e-14);
  };
  expect(PlaneShape{{0.0, 0.0, 1.0}, {0.0, 0.0, -1.0}}, {3.0, 4.0, 1.5}, -0.5, {0.0, 0.0, -1.0});
  const RoundShape capsule{{0.0, 0.0, 0.0}, {2.0, 0.0, 0.0}, 0.0, 1.0, 0.5};
  expect(capsule, {1.0, 3.0, 4.0}, 4.5, {0.0, 0.6, 0.8});
  expect(capsule, {5.0, 0.0, 4.0}, 4.5, {0.6, 0.0, 0.8});
  expect(capsule, {-3.0, 4.0, 0.0}, 4.5, {-0.6, 0.8, 0.0});
  expect(RoundShape{{0.0, 0.0, 0.0}, {2.0, 0.0, 0.0}, -INFINITY, INFINITY, 0.5}, {5.0, 0.0, 0.4}, -0.1,
         {0.0, 0.0, 1.0});
  const BoxShape box{{1.0, 1.0, 1.0}, {1.0, 2.0, 3.0}};
  expect(box, {1.5, 1.0, 1.0}, -0.5, {1.0, 0.0, 0.0});
  expect(box, {1.0, -1.5, 1.0}, 0.5, {0.0, -1.0, 0.0});
  expect(box, {-2.0, 1.0, 8.0}, std::sqrt(20.0), {-2.0 / std::sqrt(20.0), 0.0, 4.0 / std::sqrt(20.0)});
}

/// `box_surface` as an .stl file, as text or binary: of the triangles that an .obj file lists one by one.
std::string as_stl(const NodalField& corners, bool binary) {
  std::string text = binary ? std::string(80, ' ') : "solid box\n";
  const auto add = [&](const auto& value) {
    text.append(reinterpret_cast<const char*>(&value), sizeof value);
  };
  if (binary) add(static_cast<std::uint32_t>(corners.size() / 3));
  for (std::size_t n = 0; n < corners.size(); ++n) {
    const Vector& X = corners[n];
    if (binary) {
      if (n % 3 == 0) add(std::array<float, 3>{});
      add(std::array{static_cast<float>(X[0]), static_cast<float>(X[1]), static_cast<float>(X[2])});
      if (n % 3 == 2) add(std::uint16_t{0});
    } else {
      text += n % 3 == 0 ? "facet normal 0 0 0\nouter loop\n" : "";
      text += fmt::format("vertex {} {} {}\n", X[0], X[1], X[2]);
      text += n % 3 == 2 ? "endloop\nendfacet\n" : "";
    }
  }
  return text;
}

/// A surface of triangles around a box is as far from every point as the box: from its faces, edges and
/// corners, inside and outside, read from every kind of file, whichever way its triangles turn.
TEST(TriangleSurface, is_as_far_as_its_box) {
  const TemporaryFolder folder;
  const Vector half{0.5, 1.0, 2.0};
  const BoxShape box{{0.0, 0.0, 0.0}, half};
  NodalField corners, turned;
  for (int axis = 0; axis < 3; ++axis) {
    for (const double side : {-1.0, 1.0}) {
      const auto corner = [&](double p, double q) {
        Vector X{};
        X[index(axis)] = side * half[index(axis)];
        X[index((axis + 1) % 3)] = side * p * half[index((axis + 1) % 3)];
        X[index((axis + 2) % 3)] = q * half[index((axis + 2) % 3)];
        return X;
      };
      for (const auto& [p, q] :
           {std::pair{-1.0, -1.0}, {1.0, -1.0}, {1.0, 1.0}, {-1.0, -1.0}, {1.0, 1.0}, {-1.0, 1.0}})
        corners.push_back(corner(p, q));
    }
  }
  for (std::size_t n = 0; n < corners.size(); n += 3)
    turned.insert(turned.end(), {corners[n], corners[n + 2], corners[n + 1]});
  const std::vector<TriangleSurface> surfaces{
      read_triangle_surface(folder.write("box.obj", box_surface(half))),
      read_triangle_surface(folder.write("text.stl", as_stl(corners, false))),
      read_triangle_surface(folder.write("turned.stl", as_stl(turned, false))),
      read_triangle_surface(folder.write("binary.stl", as_stl(corners, true)))};
  RandomGeometry random(3);
  for (int trial = 0; trial < 2000; ++trial) {
    const Vector x{random.uniform(-1.0, 1.0), random.uniform(-2.0, 2.0), random.uniform(-4.0, 4.0)};
    const Gap expected = box.at(x);
    for (const TriangleSurface& surface : surfaces) {
      const Gap gap = surface.at(x);
      EXPECT_NEAR(gap.distance, expected.distance, 1e-14);
      EXPECT_LT(distance(gap.normal, expected.normal), 1e-12);
    }
  }
  EXPECT_LT(distance(surfaces[0].at({0.5, 0.0, 0.0}).normal, {1.0, 0.0, 0.0}), 1e-14);
}

TEST(TriangleSurface, rejects_what_is_not_closed) {
  const TemporaryFolder folder;
  const auto expect = [&](const std::string& name, const std::string& text, const std::string& said) {
    const auto path = folder.write(name, text);
    const std::string error = input_error([&] { read_triangle_surface(path); });
    EXPECT_NE(error.find(name), std::string::npos) << error;
    EXPECT_NE(error.find(said), std::string::npos) << error;
  };
  const std::string box = box_surface({1.0, 1.0, 1.0});
  expect("open.obj", replaced(box, "f 2 8 6\n", ""), "is open at the edge from ");
  expect("flipped.obj", replaced(box, "f 2 8 6\n", "f 2 6 8\n"),
         "or its triangles have opposite orientations");
  expect("branch.obj", box + "f 2 8 6\n", "the surface branches");
  expect("flat.obj", box + "f 1 1 2\n", "has no area, and so no normal");
  expect("lost.obj", box + "f 1 2 9\n", "names a point that is not there");
  expect("short.obj", "v 1 2\n", "must have three coordinates");
  expect("empty.stl", "solid nothing\n", "no triangle");
  expect("box.ply", box, "unknown ending");
  const std::string missing = input_error([&] { read_triangle_surface(folder / "none.stl"); });
  EXPECT_NE(missing.find("cannot be read"), std::string::npos) << missing;
}

/// A surface of triangles that a case names presses as the box that it is.
TEST(TriangleSurface, presses_like_its_box) {
  const TemporaryFolder folder;
  folder.write("box.obj", box_surface({0.7, 0.3, 0.2}));
  Column column({1.0, 1.0, 1.0}, {4, 4, 4}, NeoHookean{.young_modulus = 3000.0, .poisson_ratio = 0.3});
  column.description.file = folder / "pressed.toml";
  column.description.displacements = {{"foot", {}}};
  Obstacle block{.label = "block", .set = "top", .shape = Obstacle::Shape::box, .point = {0.5, 0.5, 1.21}};
  block.half_sizes = {0.7, 0.3, 0.2};
  block.displacement = {0.0, 0.0, -0.1};
  Obstacle surface = block;
  surface.shape = Obstacle::Shape::surface;
  surface.half_sizes = {};
  surface.file = "box.obj";
  std::vector<double> forces;
  for (const Obstacle& one : {block, surface}) {
    column.description.forces.of<Obstacle>() = {one};
    Recorder recorder;
    const Scene scene = column.scene();
    const Relaxation found = relax(Model(scene, {"tl-perturbation"}), recorder);
    EXPECT_TRUE(found.converged);
    forces.push_back(recorder.rows.back().reactions.at("block")[2]);
  }
  EXPECT_LT(forces[0], -1.0);
  EXPECT_NEAR(forces[0], forces[1], 1e-6 * std::abs(forces[0]));
}

TEST(Contact, rejects_wrong_input) {
  const TemporaryFolder folder;
  const std::string base =
      box_case("pressed", "[1.0, 1.0, 1.0]", "[2, 2, 2]") +
      "[sets]\nfoot = { z = [0.0, 0.0] }\ntop = { z = [1.0, 1.0] }\n\n[[displacement]]\nset = "
      "\"foot\"\nvalue = [0.0, 0.0, 0.0]\n\n";
  const auto expect = [&](const std::string& table, const std::string& said) {
    const auto path = folder.write("pressed.toml", base + table);
    const std::string text = input_error([&] { read_scene(path); });
    EXPECT_NE(text.find(said), std::string::npos) << text;
  };
  const std::string head = "[[obstacle]]\nname = \"tool\"\nset = \"top\"\nshape = ";
  expect(head + "\"plane\"\npoint = [0, 0, 2]\n",
         "normal is needed for shape = 'plane' and must have a length");
  expect(head + "\"sphere\"\npoint = [0.0, 0.0, 2.0]\n",
         "radius is needed for shape = 'sphere' and must be positive");
  expect(head + "\"capsule\"\npoint = [0.0, 0.0, 2.0]\nend = [0.0, 0.0, 2.0]\nradius = 0.1\n",
         "must differ from point");
  expect(head + "\"box\"\npoint = [0, 0, 2]\nhalf_sizes = [1.0, 1.0, 0.0]\n",
         "half_sizes is needed for shape = 'box'");
  expect(head + "\"sphere\"\npoint = [0, 0, 2]\nradius = 0.1\nnormal = [0.0, 0.0, 1.0]\n",
         "normal has no meaning for shape = 'sphere'");
  expect(head + "\"sphere\"\nradius = 0.1\n", "point is needed for shape = 'sphere' and has no default");
  expect(head + "\"ball\"\n", "plane");
  expect(head + "\"sphere\"\npoint = [0.5, 0.5, 1.2]\nradius = 0.3\n",
         "at (0.5, 0.5, 1) m is 0.1 m inside it at the start");
  expect(head + "\"sphere\"\npoint = [0.5, 0.5, 0.5]\nradius = 0.6\ninside = true\n",
         "allowed: a body inside it");
  const std::string sphere = head + "\"sphere\"\npoint = [0.5, 0.5, 2.0]\nradius = 0.3\n";
  expect(sphere + sphere, "another obstacle has the same name");
  std::string other = sphere;
  expect(other.replace(other.find("tool"), 4, "foot"), "a node set has the same name");
  const auto path = folder.write("pressed.toml", base + sphere + "friction = 0.2\n");
  Recorder silent;
  const auto asleep = input_error([&] { relax_awake(read_scene(path), {"tl-perturbation"}, 0.01, silent); });
  EXPECT_NE(asleep.find("allowed: a case without [[obstacle]]"), std::string::npos) << asleep;
}

}  // namespace
}  // namespace sandglass::verification::contact_test
