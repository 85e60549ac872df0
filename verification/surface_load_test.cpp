/// Loads on faces and in the body: pressures that follow the surface, springs and dashpots, weight, and their
/// curves. Exact answers.

#include <gtest/gtest.h>

#include <map>
#include <numbers>

#include "assembly/method_entry.hpp"
#include "element/methods.hpp"
#include "io/case_file.hpp"
#include "mesh/face_load.hpp"
#include "solve/central_difference.hpp"
#include "solve/relaxation.hpp"
#include "solve/stable_step.hpp"
#include "support/case_text.hpp"
#include "support/method_test.hpp"
#include "support/obstacles.hpp"
#include "support/random_hexahedra.hpp"
#include "support/sample_law.hpp"
#include "support/scenes.hpp"
#include "support/temporary_folder.hpp"

namespace sandglass::verification::surface_load_test {
namespace {

/// Three planes of symmetry through the origin.
void add_symmetry(const NodalField& points, Case& description, NodeSets& sets) {
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const std::string name(1, "xyz"[axis]);
    sets[name] = plane(points, axis, 0.0);
    description.displacements.push_back({name, {}, {axis == 0, axis == 1, axis == 2}});
  }
}

NodalField answer(const Scene& scene, const MethodChoice& choice) {
  Recorder recorder;
  const Relaxation found = relax(Model(scene, choice), recorder);
  EXPECT_TRUE(found.converged) << choice.method;
  return found.u;
}

/// The forces on a closed surface sum to zero, and the work of a pressure of 1 Pa is the change of the
/// volume, for hexahedra of any shape, whose faces are warped.
TEST(Pressure, does_the_work_of_the_volume) {
  RandomGeometry random(3);
  Mesh mesh = box({1.0, 1.0, 1.0}, {1, 1, 1});
  for (auto& X : mesh.points) {
    for (double& x : X) x += 0.2 * random.uniform(-1.0, 1.0);
  }
  const auto volume = [&] { return mean_gradient(gather(mesh.points, mesh.cells[0])).volume; };
  NodalField forces(8);
  Vector sum{};
  for (const auto& face : boundary_faces(mesh.cells)) {
    const auto on_face = pressure_forces(corners_of(mesh.points, face));
    for (std::size_t I = 0; I < 4; ++I) {
      for (std::size_t i = 0; i < 3; ++i) {
        forces[index(face[I])][i] += on_face[I][i];
        sum[i] += on_face[I][i];
      }
    }
  }
  for (const double component : sum) EXPECT_NEAR(component, 0.0, 1e-14);
  for (std::size_t n = 0; n < 8; ++n) {
    for (std::size_t i = 0; i < 3; ++i) {
      const double h = 1e-3;  // the volume is cubic in all coordinates together, linear in each
      mesh.points[n][i] += h;
      const double up = volume();
      mesh.points[n][i] -= 2.0 * h;
      EXPECT_NEAR(-forces[n][i], (up - volume()) / (2.0 * h), 1e-12);
      mesh.points[n][i] += h;
    }
  }
}

struct PressedTest : MethodTest {};
INSTANTIATE_TEST_SUITE_P(, PressedTest, each_of(Methods{}), method_label);

/// A body of any shape under the same pressure from all sides shrinks uniformly, K (J - 1) = -p.
TEST_P(PressedTest, a_body_under_pressure_shrinks_uniformly) {
  if (method.is_linear || is_updated_lagrangian(method)) {
    GTEST_SKIP() << "of small strains, or of the path";
  }
  if (leaves_hourglass_modes(choice())) GTEST_SKIP() << "has no equilibrium";
  const NeoHookean law{.young_modulus = 3000.0, .poisson_ratio = 0.3};
  Case description = plain_case(law);
  const Mesh mesh = box({0.1, 0.12, 0.15}, {3, 3, 4});
  NodeSets sets;
  add_symmetry(mesh.points, description, sets);
  const std::array<double, 3> size{0.1, 0.12, 0.15};
  constexpr double p = 500.0;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const std::string name = "far " + std::to_string(axis);
    sets[name] = plane(mesh.points, axis, size[axis]);
    description.forces.of<Pressure>().push_back({name, p});
  }
  const Scene scene = make_scene(description, mesh, sets);
  const double stretch = std::cbrt(1.0 - p / law.bulk_modulus());
  NodalField exact;
  for (const Vector& X : mesh.points) {
    exact.push_back({(stretch - 1.0) * X[0], (stretch - 1.0) * X[1], (stretch - 1.0) * X[2]});
  }
  EXPECT_LT(largest_distance(answer(scene, choice()), exact), 1e-7 * (1.0 - stretch) * 0.15);
}

/// A thick ball, from the faces of a cube of n x n elements each.
Mesh ball(int n, double inner, double outer) {
  Mesh mesh;
  std::map<std::array<long, 3>, int> known;
  const auto node = [&](const Vector& X) {
    const std::array<long, 3> key{std::lround(1e9 * X[0]), std::lround(1e9 * X[1]), std::lround(1e9 * X[2])};
    const auto [at, is_new] = known.try_emplace(key, static_cast<int>(mesh.points.size()));
    if (is_new) mesh.points.push_back(X);
    return at->second;
  };
  for (std::size_t axis = 0; axis < 3; ++axis) {
    for (const double side : {-1.0, 1.0}) {
      const auto point = [&](int a, int b, int layer) {
        const auto angle = [&](int k) { return std::tan((2.0 * k / n - 1.0) * std::numbers::pi / 4.0); };
        Vector d{};
        d[axis] = side;
        d[(axis + 1) % 3] = side * angle(a);
        d[(axis + 2) % 3] = angle(b);
        const double r = inner * std::pow(outer / inner, static_cast<double>(layer) / n) / length(d);
        return node({r * d[0], r * d[1], r * d[2]});
      };
      for (int a = 0; a < n; ++a) {
        for (int b = 0; b < n; ++b) {
          for (int k = 0; k < n; ++k) {
            mesh.cells.push_back({point(a, b, k), point(a + 1, b, k), point(a + 1, b + 1, k),
                                  point(a, b + 1, k), point(a, b, k + 1), point(a + 1, b, k + 1),
                                  point(a + 1, b + 1, k + 1), point(a, b + 1, k + 1)});
          }
        }
      }
    }
  }
  return mesh;
}

/// The pressure that inflates an incompressible neo-Hookean ball (Green and Zerna, Theoretical Elasticity,
/// 1954): mu/2 (4/b + 1/b^4 - 4/a - 1/a^4), with stretches a and b inside and outside. Elements of half the
/// size divide the error of the displacement inside by four.
TEST(Pressure, inflates_a_ball_as_theory_says) {
  const double inner = 1.0, outer = 2.0, a = 1.3;
  const double b = std::cbrt(1.0 + (a * a * a - 1.0) * std::pow(inner / outer, 3.0));
  const NeoHookean law{.young_modulus = 3.0, .poisson_ratio = 0.49999};
  const double p = 0.5 * law.shear_modulus() * (4.0 / b + std::pow(b, -4.0) - 4.0 / a - std::pow(a, -4.0));
  std::vector<double> errors;
  for (const int n : {4, 8}) {
    Case description = plain_case(law);
    const Mesh mesh = ball(n, inner, outer);
    NodeSets sets{
        {"inside", nodes_where(mesh.points, [&](const Vector& X) { return length(X) < 1.0 + 1e-6; })}};
    add_symmetry(mesh.points, description, sets);
    description.forces.of<Pressure>() = {{"inside", p}};
    const NodalField u = answer(make_scene(description, mesh, sets), {"tl-mean-dilatation"});
    double error = 0.0;
    for (const int node : sets["inside"]) {
      error = std::max(error, std::abs(length(u[index(node)]) - (a - 1.0) * inner));
    }
    errors.push_back(error / (a - 1.0));
  }
  EXPECT_LT(errors[1], 0.03);
  EXPECT_GT(errors[0], 3.0 * errors[1]);
}

/// A column under its weight between smooth walls: as in a bar, linear elements are exact at the nodes.
TEST(Gravity, presses_a_column_together) {
  const NeoHookean law{.young_modulus = 3000.0, .poisson_ratio = 0.3};
  Case description = plain_case(law, 800.0);
  const double H = 0.4, g = 0.1;
  const Mesh mesh = box({0.1, 0.1, H}, {2, 2, 7});
  NodeSets sets{{"all", nodes_where(mesh.points, [](const Vector&) { return true; })},
                {"foot", plane(mesh.points, 2, 0.0)}};
  description.displacements = {{"all", {}, {true, true, false}}, {"foot", {}, {false, false, true}}};
  description.forces.of<Gravity>() = {{{0.0, 0.0, -g}}};
  NodalField exact;
  const double modulus = lame_lambda(law) + 2.0 * law.shear_modulus();
  for (const Vector& X : mesh.points) {
    exact.push_back({0.0, 0.0, -800.0 * g / modulus * (H * X[2] - 0.5 * X[2] * X[2])});
  }
  const Scene scene = make_scene(description, mesh, sets);
  EXPECT_LT(largest_distance(answer(scene, {"linear"}), exact), 1e-7 * 800.0 * g / modulus * H * H);
  EXPECT_LT(largest_distance(answer(scene, {"linear-condensed"}), exact), 1e-7 * 800.0 * g / modulus * H * H);
}

/// A body falls freely: u = g t^2 / 2 at all nodes without stress, as central differences give it. Its mesh
/// is distorted: the weight of a node is that of its lumped mass.
TEST(Gravity, lets_a_body_fall) {
  Mesh mesh = box({0.1, 0.1, 0.2}, {2, 2, 4});
  RandomGeometry random(9);
  for (auto& X : mesh.points) {
    for (double& x : X) x += 0.01 * random.uniform(-1.0, 1.0);
  }
  Case description = plain_case(NeoHookean{.young_modulus = 3000.0, .poisson_ratio = 0.45});
  description.quasi_static = false;
  description.forces.of<Gravity>() = {{{0.0, 3.0, -9.81}, {{0.0}, {1.0}}}};
  description.dynamics = {.duration = 0.2};
  Recorder recorder;
  const Motion motion = integrate(Model(make_scene(description, mesh, {}), {"tl-mean-dilatation"}), recorder);
  for (const Vector& u : motion.u) {
    EXPECT_NEAR(u[1], 0.5 * 3.0 * 0.04, 1e-12);
    EXPECT_NEAR(u[2], -0.5 * 9.81 * 0.04, 1e-12);
  }
  EXPECT_LT(recorder.rows.back().strain, 1e-20);
}

/// Springs carry the weight of a body, which nothing else holds: k times their mean displacement times the
/// area.
TEST_P(PressedTest, springs_carry_the_weight) {
  if (method.is_condensed) GTEST_SKIP() << "refuses springs";
  if (leaves_hourglass_modes(choice())) GTEST_SKIP() << "has no equilibrium";
  Case description = plain_case(NeoHookean{.young_modulus = 30000.0, .poisson_ratio = 0.45});
  const Mesh mesh = box({0.1, 0.1, 0.2}, {2, 2, 4});
  NodeSets sets{{"foot", plane(mesh.points, 2, 0.0)}};
  const double k = 1e6;
  description.forces.of<Support>() = {{"foot", k, 0.0, false}};
  description.forces.of<Gravity>() = {{{1.0, 0.5, -9.81}}};
  const Scene scene = make_scene(description, mesh, sets);
  const NodalField u = answer(scene, choice());
  Vector sum{};
  for (const Quadrilateral& face : faces_within(scene.boundary, sets.at("foot"))) {
    for (const auto& point : gauss_points_of(corners_of(mesh.points, face))) {
      for (std::size_t I = 0; I < 4; ++I) {
        for (std::size_t i = 0; i < 3; ++i) {
          sum[i] += k * point.N[I] * point.area * u[index(face[I])][i];
        }
      }
    }
  }
  const double mass = 1000.0 * 0.1 * 0.1 * 0.2;
  EXPECT_NEAR(sum[0], mass * 1.0, 1e-6 * mass * 9.81);
  EXPECT_NEAR(sum[1], mass * 0.5, 1e-6 * mass * 9.81);
  EXPECT_NEAR(sum[2], -mass * 9.81, 1e-6 * mass * 9.81);
}

TEST(LoadCurve, is_linear_between_its_points) {
  const LoadCurve curve{{1.0, 2.0, 4.0}, {0.5, 1.0, -1.0}};
  for (const auto& [t, f] :
       {std::pair{0.0, 0.5}, {1.0, 0.5}, {1.5, 0.75}, {2.0, 1.0}, {3.0, 0.0}, {9.0, -1.0}}) {
    EXPECT_DOUBLE_EQ(curve.at(t, 0.3), f) << t;
  }
  EXPECT_EQ(LoadCurve{}.at(5.0, 0.3), 0.3);
}

/// Static answers use the loads at the end of their curves.
TEST(LoadCurve, a_quasi_static_answer_is_that_of_its_end) {
  Case description = plain_case(NeoHookean{.young_modulus = 3000.0, .poisson_ratio = 0.45});
  const Mesh mesh = box({0.1, 0.1, 0.2}, {2, 2, 4});
  const NodeSets sets{{"foot", plane(mesh.points, 2, 0.0)}, {"head", plane(mesh.points, 2, 0.2)}};
  description.displacements = {{"foot", {}}};
  description.forces.of<Pressure>() = {{"head", 100.0, {{0.0, 0.5, 1.0}, {0.0, 2.0, 0.7}}}};
  const NodalField with_curve = answer(make_scene(description, mesh, sets), {"tl-perturbation"});
  description.forces.of<Pressure>() = {{"head", 70.0}};
  const NodalField plain = answer(make_scene(description, mesh, sets), {"tl-perturbation"});
  EXPECT_LT(largest_distance(with_curve, plain), 1e-6 * largest_distance(plain, NodalField(plain.size())));
}

TEST(Loads, wrong_input_is_refused) {
  const TemporaryFolder folder;
  const std::string base = box_case("pressed", "[1.0, 1.0, 2.0]", "[1, 1, 2]") + R"(
[sets]
foot = { z = [0.0, 0.0] }
edge = { z = [0.0, 0.0], x = [0.0, 0.0] }

[[displacement]]
set = "foot"
value = [0.0, 0.0, 0.0]

)";
  const auto expect = [&](const std::string& table, const std::string& said) {
    const auto path = folder.write("pressed.toml", base + table);
    const std::string text = input_error([&] { read_scene(path); });
    EXPECT_NE(text.find(said), std::string::npos) << text;
  };
  expect("[[pressure]]\nset = \"edge\"\nvalue = 1.0\n", "pressure.set = 'edge' has no boundary face");
  expect("[[pressure]]\nset = \"food\"\nvalue = 1.0\n", "did you mean 'foot'?");
  expect("[[pressure]]\nset = \"foot\"\n", "value is missing");
  expect("[[support]]\nset = \"foot\"\n", "or damping must be given and positive");
  expect("[[support]]\nset = \"foot\"\nstiffness = -1.0\n", "must be in [0, inf)");
  expect("[[gravity]]\nvalue = [0.0, 1.0]\n", "a list of 3");
  expect("[[gravity]]\nvalue = [0.0, 1.0, 0.0]\ntimes = [0.0, 1.0]\n", "one factor for each time");
  expect("[[gravity]]\nvalue = [0.0, 1.0, 0.0]\ntimes = [0.0, 0.0]\nfactors = [0.0, 1.0]\n", "must increase");
  expect("[[gravity]]\nvalue = [0.0, 1.0, 0.0]\nset = \"foot\"\n", "set");
  const auto path = folder.write("pressed.toml", base + "[[pressure]]\nset = \"foot\"\nvalue = 1.0\n");
  const Scene scene = read_scene(path);
  EXPECT_THROW(answer(scene, {"linear-condensed"}), ComputationError);
}

}  // namespace
}  // namespace sandglass::verification::surface_load_test
