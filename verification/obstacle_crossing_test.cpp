/// Nodes that leap over a thin obstacle within one step or one load level: each touches it, on the side from
/// which it came, or ends the run. Random speeds, thicknesses, shapes and ways, by all methods.

#include <gtest/gtest.h>

#include <numeric>

#include "base/error.hpp"
#include "forces/contact_force.hpp"
#include "forces/triangle_surface.hpp"
#include "sandglass/simulation.hpp"
#include "solve/central_difference.hpp"
#include "solve/relaxation.hpp"
#include "support/case_text.hpp"
#include "support/obstacles.hpp"
#include "support/random_hexahedra.hpp"
#include "support/temporary_folder.hpp"

namespace sandglass::verification::obstacle_crossing_test {
namespace {

/// An obstacle about the origin, with half its thickness (m) and its distances.
struct Thin {
  Obstacle given;
  ObstacleShape shape;

  Gap at(const Vector& x) const {
    return std::visit([&](const auto& one) { return one.at(x); }, shape);
  }
  double half() const {
    return std::visit([](const auto& one) { return one.half_thickness(); }, shape);
  }
};

/// A surface, from the text of an .obj file.
Thin surface_obstacle(const TemporaryFolder& folder, const std::string& name, const std::string& text) {
  const auto path = folder.write(name, text);
  return {{.shape = Obstacle::Shape::surface, .file = name},
          SurfaceShape{std::make_shared<TriangleSurface>(read_triangle_surface(path)), {}}};
}

/// Of each shape, with the half thickness t. The second surface is a plate along a diagonal: it is thinner
/// than the box around it.
std::vector<Thin> thin_obstacles(double t, const TemporaryFolder& folder) {
  using Shape = Obstacle::Shape;
  const Vector end{0.3, 0.1, -0.2}, sizes{0.4, t, 0.5};
  std::string oblique;
  for (const double z : {-0.5, 0.5}) {
    for (const double s : {-0.4, 0.4})
      for (const double d : {-t, t}) oblique += fmt::format("v {} {} {}\n", s - d, s + d, z);
  }
  oblique += "f 1 2 4 3\nf 5 7 8 6\nf 1 5 6 2\nf 3 4 8 7\nf 1 3 7 5\nf 2 6 8 4\n";
  return {{{.shape = Shape::sphere, .radius = t}, RoundShape{{}, {}, 0.0, 0.0, t}},
          {{.shape = Shape::capsule, .end = end, .radius = t}, RoundShape{{}, end, 0.0, 1.0, t}},
          {{.shape = Shape::cylinder, .end = end, .radius = t}, RoundShape{{}, end, -INFINITY, INFINITY, t}},
          {{.shape = Shape::box, .half_sizes = sizes}, BoxShape{{}, sizes}},
          {{.shape = Shape::ellipsoid, .half_sizes = sizes}, EllipsoidShape{{}, sizes}},
          surface_obstacle(folder, "plate.obj", box_surface(sizes)),
          surface_obstacle(folder, "oblique.obj", oblique)};
}

enum class Step { kinematic, penalty, level };

/// The corners of a small cube that jump together past an obstacle, from one evaluation to the next.
struct Jump {
  Mesh mesh = box({1.0, 1.0, 1.0}, {1, 1, 1});
  std::vector<Quadrilateral> boundary = boundary_faces(mesh.cells);
  NodeSets sets{{"all", {0, 1, 2, 3, 4, 5, 6, 7}}};
  std::vector<double> masses = std::vector<double>(8, 1.0);
  std::vector<int> places{0, 1, 2, 3, 4, 5, 6, 7};

  Jump(const Vector& corner, double edge) {
    for (Vector& X : mesh.points) X = sum(corner, edge, X);
  }

  /// How it touched an obstacle on a way (m).
  Touch along(const Vector& way, Obstacle obstacle, Step step, const std::string& file) {
    obstacle.label = "tool";
    obstacle.set = "all";
    obstacle.method = step == Step::kinematic ? Obstacle::Method::kinematic : Obstacle::Method::penalty;
    ForceResolver resolver{file, mesh.points, boundary, sets, masses};
    resolver.cells = mesh.cells;
    resolver.young_moduli = {1000.0};
    obstacle.resolve(resolver);
    const BodyForces forces = step == Step::level ? at_rest(resolver.all()) : resolver.all();
    const ContactForce& contact = *contacts_of(forces).front();
    const std::vector<double> factors(resolver.curves.size(), 0.0);
    Rows<double> memory(contact.memory());
    for (const double share : {0.0, 1.0}) {
      Rows<double> u(8), sums(8), inverse(8);
      for (std::size_t n = 0; n < 8; ++n) {
        for (std::size_t i = 0; i < 3; ++i) u[n][i] = share * way[i], inverse[n][i] = 1.0;
      }
      Rows<double> increment = u;
      const Rows<double> last(8);
      const NodalRows now(u.data(), places);
      contact.add_contact(factors, now, memory.data(), {sums.data(), places});
      contact.push_out(factors, {{u.data(), places},
                                 {increment.data(), places},
                                 {last.data(), places},
                                 {std::as_const(inverse).data(), places},
                                 1.0,
                                 memory.data()});
      contact.end_level(factors, now, false, memory.data());
    }
    return contact.touch(memory.data());
  }
};

/// The least distance (m) on a way, by comparing 2001 places.
double nearest_on(const Thin& thin, const Vector& from, const Vector& way) {
  double least = INFINITY;
  for (int k = 0; k <= 2000; ++k) least = std::min(least, thin.at(sum(from, k / 2000.0, way)).distance);
  return least;
}

/// A way without an error ends inside, where the obstacle pushes back to the side of the start, or outside,
/// on this side, and cuts at most a corner, of a tenth of half the thickness. A way that is always outside,
/// by more than the resolution, is no error.
TEST(ObstacleCrossing, no_node_leaps_over_an_obstacle_in_silence) {
  const TemporaryFolder folder;
  RandomGeometry random(47);
  int leapt = 0, touched = 0, clear = 0;
  for (int trial = 0; trial < 400; ++trial) {
    const double t = 0.1 * std::pow(10.0, random.uniform(-2.0, 0.0)), edge = 1e-3 * t;
    for (const Thin& thin : thin_obstacles(t, folder)) {
      Vector from, onto;
      for (std::size_t i = 0; i < 3; ++i) {
        from[i] = random.uniform(-3.0, 3.0) * t;
        onto[i] = random.uniform(-1.0, 1.0) * t;
      }
      const Vector way = sum({}, random.uniform(0.2, 4.0), difference(onto, from));
      if (thin.at(from).distance < 4.0 * edge) continue;
      for (const Step step : {Step::kinematic, Step::penalty, Step::level}) {
        Jump jump(from, edge);
        const Touch touch = jump.along(way, thin.given, step, folder / "a.toml");
        // Distances of corners differ by at most the diagonal of the cube; places have finite distances.
        const double nearest = nearest_on(thin, from, way), rounding = 2.0 * edge + 2e-3 * length(way);
        const Gap start = thin.at(from), end = thin.at(sum(from, 1.0, way));
        if (touch.passed >= 0) {
          EXPECT_LT(nearest, rounding);
          ++leapt;
        } else if (end.distance > rounding) {
          const bool turned = dot(start.normal, end.normal) < -0.02;
          EXPECT_GT(nearest, turned ? -rounding : -0.1 * thin.half() - rounding);
          ++clear;
        } else if (end.distance < -rounding) {
          EXPECT_GT(dot(start.normal, end.normal), -0.02);
          EXPECT_GT(end.distance, -0.8 * thin.half() - rounding);
          ++touched;
        }
      }
    }
  }
  EXPECT_GT(std::min({leapt, touched, clear}), 500);
}

/// A block thrown onto a plate, or a plate that is moved into the foot of a held block, within any number of
/// steps: the foot stays on its side, or the run ends with an error.
TEST(ObstacleCrossing, thrown_and_pressed_bodies_stay_on_their_side) {
  const TemporaryFolder folder;
  RandomGeometry random(4);
  constexpr double h = 0.02, modulus = 1e4, density = 1000.0;
  const double wave_speed = std::sqrt(modulus / density);
  int ended = 0, touched = 0;
  for (int trial = 0; trial < 150; ++trial) {
    const double t = h * std::pow(10.0, random.uniform(-2.0, 0.0)), gap = h * random.uniform(0.05, 1.0);
    const Vector sizes{0.5, 0.5, t};
    using Shape = Obstacle::Shape;
    const auto shape = std::array{Shape::box, Shape::ellipsoid, Shape::surface}[at(trial % 3)];
    Obstacle plate{.label = "plate", .set = "foot", .shape = shape};
    if (shape == Shape::surface) {
      plate = surface_obstacle(folder, "plate.obj", box_surface(sizes)).given;
      plate.label = "plate";
      plate.set = "foot";
    } else {
      plate.half_sizes = sizes;
    }
    const int kind = trial / 3 % 3;
    plate.method = kind == 0 ? Obstacle::Method::penalty : Obstacle::Method::kinematic;
    Column block({h, h, h}, {1, 1, 2}, NeoHookean{.young_modulus = modulus, .poisson_ratio = 0.3});
    for (Vector& X : block.mesh.points) X = sum(X, 1.0, {-0.5 * h, -0.5 * h, t + gap});
    block.description.file = folder / "a.toml";
    Vector up{};
    if (kind == 2) {
      up[2] = gap + h * random.uniform(0.05, 0.6) + 2.0 * t * random.uniform(0.0, 1.2);
      plate.displacement = up;
      block.description.displacements = {{"top", {}}};
      block.description.relaxation.levels = trial % 4;
    } else {
      const double speed = wave_speed * std::pow(10.0, random.uniform(-1.0, 0.3));
      block.description.quasi_static = false;
      block.description.velocities = {{.set = "", .value = {0.0, 0.0, -speed}}};
      block.description.dynamics.duration = (gap + 2.0 * t + 2.0 * h) / speed;
    }
    block.description.forces.of<Obstacle>() = {plate};
    const Scene scene = block.scene();
    const Model model(scene, {"tl-perturbation"});
    Observer silent;
    try {
      const NodalField u = kind == 2 ? relax(model, silent).u : integrate(model, silent).u;
      for (const int node : scene.sets.at("foot"))
        EXPECT_GT(scene.mesh.points[at(node)][2] + u[at(node)][2] - up[2], 0.0) << trial;
      ++touched;
    } catch (const ComputationError&) {
      ++ended;
    }
  }
  EXPECT_GT(std::min(ended, touched), 20);
}

/// In a program as well: a plate of a hundredth of the way of a step. The body is back at the last check.
TEST(ObstacleCrossing, ends_the_motion_of_a_program) {
  const TemporaryFolder folder;
  for (const std::string method : {"kinematic", "penalty"}) {
    const auto file = folder.write(
        "a.toml", replaced(box_case("thrown", "[0.1, 0.1, 0.1]", "[2, 2, 2]"), "quasi-static", "dynamic") +
                      fmt::format("[sets]\nfoot = {{ z = [0.0, 0.0] }}\n"
                                  "[[velocity]]\nvalue = [0.0, 0.0, -20.0]\n"
                                  "[[obstacle]]\nname = \"plate\"\nset = \"foot\"\nshape = \"box\"\n"
                                  "point = [0.05, 0.05, -0.03]\nhalf_sizes = [0.5, 0.5, 0.0003]\n"
                                  "method = \"{}\"\npenalty = 1e-3\n[dynamics]\nduration = 1.0\n",
                                  method));
    Simulation<double> body(file);
    EXPECT_THROW(body.advance(0.01), ComputationError) << method;
    EXPECT_LT(body.time(), 0.01);
  }
}

}  // namespace
}  // namespace sandglass::verification::obstacle_crossing_test
