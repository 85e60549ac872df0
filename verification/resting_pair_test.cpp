/// Two deformable bodies that touch in static equilibrium, without friction; static_friction_test.cpp has
/// that.

#include <gtest/gtest.h>

#include <map>
#include <numbers>

#include "base/error.hpp"
#include "io/case_file.hpp"
#include "sandglass/simulation.hpp"
#include "solve/central_difference.hpp"
#include "solve/health.hpp"
#include "support/pressed.hpp"
#include "support/random_hexahedra.hpp"
#include "support/static_answer.hpp"
#include "support/two_bodies.hpp"

namespace sandglass::verification::resting_pair_test {
namespace {

struct Rest {
  Relaxation found;
  HistoryRow last;
};

Rest rest_of(const Model& model) {
  Recorder recorder;
  Relaxation found = relax(model, recorder);
  EXPECT_TRUE(found.converged);
  return {std::move(found), recorder.rows.back()};
}

/// At rest, pressed by the set "top", with the contact of two of its sets.
void press(TwoBodies& bodies, const std::string& set, const std::string& other, double fall) {
  bodies.description.quasi_static = true;
  bodies.description.forces.of<Contact>() = {pair_of(set, other, Contact::Method::penalty)};
  bodies.description.displacements = {{"foot", {}}, {"top", {0.0, 0.0, -fall}}};
}

/// Two equal blocks, one on the other or `gap` (m) above it.
TwoBodies blocks(int n, double gap, double fall) {
  TwoBodies two(box({1.0, 1.0, 0.5}, {n, n, n / 2}),
                moved(box({1.0, 1.0, 0.5}, {n, n, n / 2}), {0.0, 0.0, 0.5 + gap}),
                NeoHookean{.young_modulus = 1e4, .poisson_ratio = 0.45});
  press(two, "under", "over", gap + fall);
  return two;
}

/// The plane between two equal blocks is one of symmetry, so that they answer as one block: displacements to
/// about the depth, and forces to its share of the fall, times at most two as the blocks stiffen. The search
/// takes more evaluations as it also finds what touches, but not many times more.
TEST(RestingPair, answers_as_one_block) {
  const int n = 6;
  for (const double fall : {0.02, 0.2}) {
    Case description = plain_case(NeoHookean{.young_modulus = 1e4, .poisson_ratio = 0.45}, 1000.0);
    description.displacements = {{"foot", {}}, {"top", {0.0, 0.0, -fall}}};
    const Mesh whole = box({1.0, 1.0, 1.0}, {n, n, n});
    const Scene scene_of_one = make_scene(
        description, whole, {{"foot", plane(whole.points, 2, 0.0)}, {"top", plane(whole.points, 2, 1.0)}});
    const Rest one = rest_of(Model(scene_of_one, {"tl-perturbation"}));
    const TwoBodies bodies = blocks(n, 0.0, fall);
    const Scene scene = bodies.scene();
    const Rest two = rest_of(Model(scene, {"tl-perturbation"}));
    const double depth = two.last.depth, edge = 1.0 / n;
    EXPECT_LT(depth, 0.01 * edge);
    EXPECT_LT(two.found.steps, 5 * one.found.steps);
    const double F = one.last.reactions.at("top")[2];
    EXPECT_NEAR(two.last.reactions.at("top")[2] / F, 1.0, 2.0 * depth / fall + 1e-6);
    EXPECT_NEAR(two.last.reactions.at("pair")[2] / F, 1.0, 2.0 * depth / fall + 1e-6);
    std::map<std::array<long, 3>, Vector> at_place;
    const auto place = [](const Vector& X) {
      return std::array{std::lround(1e6 * X[0]), std::lround(1e6 * X[1]), std::lround(1e6 * X[2])};
    };
    for (std::size_t k = 0; k < whole.points.size(); ++k) at_place[place(whole.points[k])] = one.found.u[k];
    for (std::size_t k = 0; k < two.found.u.size(); ++k) {
      EXPECT_LT(distance(two.found.u[k], at_place.at(place(scene.mesh.points[k]))), depth + 1e-6 * fall);
    }
  }
}

/// Nothing stops the upper body until it has fallen by 1.8 elements. Then it presses as one that lay on the
/// lower body from the start.
TEST(RestingPair, finds_what_meets_far_from_the_start) {
  const double gap = 0.3, fall = 0.25;
  const TwoBodies near = blocks(6, 0.0, fall), far = blocks(6, gap, fall);
  const Rest one = rest_of(Model(near.scene(), {"tl-perturbation"}));
  const Rest two = rest_of(Model(far.scene(), {"tl-perturbation"}));
  const double F = one.last.reactions.at("pair")[2];
  EXPECT_NEAR(two.last.reactions.at("pair")[2], F, 1e-4 * std::abs(F));
}

/// The stack of FEBio's test co01: cubes with E = 1 Pa and nu = 0 shorten to .9 under the pressure
/// mu (1 - .9^2) / .9 = .105556 Pa. The depth shortens them less; the force falls by E times that or less, as
/// this law stiffens to 1.5 E at most.
TEST(RestingPair, shortens_a_stack_as_published) {
  TwoBodies stack(box({1.0, 1.0, 1.0}, {2, 2, 2}), moved(box({1.0, 1.0, 1.0}, {2, 2, 2}), {0.0, 0.0, 1.0}),
                  CompressibleNeoHookean{.young_modulus = 1.0, .poisson_ratio = 0.0});
  press(stack, "under", "over", 0.2);
  const Rest rest = rest_of(Model(stack.scene(), {"tl-mean-dilatation"}));
  EXPECT_LT(rest.last.depth, 1e-3);
  EXPECT_NEAR(rest.last.reactions.at("top")[2], -0.105556, 1e-6 + 1.5 * rest.last.depth);
  for (const int node : stack.sets.at("under")) EXPECT_NEAR(rest.found.u[at(node)][2], -0.1, rest.last.depth);
}

/// The patch test of contact (SSNP121 of Code_Aster), at rest. Between meshes that do not match, forces of
/// points at Simpson's places do not see where elements of the other mesh end; nodes alone err by 6 %. The
/// upper plate is held vertically by the contact alone.
TEST(RestingPair, passes_the_patch_test) {
  for (const auto& [below, above, limit] :
       {std::tuple{4, 4, 1e-4}, {6, 2, 1e-4}, {4, 3, 0.01}, {16, 12, 0.01}}) {
    const double E = 2e6, p = 1e5;
    TwoBodies plates(box({2.0, 1.0, 1.0}, {below, 1, 4}),
                     moved(box({2.0, 1.0, 1.0}, {above, 2, 4}), {0.0, 0.0, 1.0}),
                     NeoHookean{.young_modulus = E, .poisson_ratio = 0.0});
    press(plates, "under", "over", 0.0);
    plates.description.forces.of<Pressure>() = {{.set = "top", .value = p}};
    plates.description.displacements.back().components = {true, true, false};
    const Scene scene = plates.scene();
    const Rest rest = rest_of(Model(scene, {"linear"}));
    const auto& interface = plates.sets.at("under");
    double mean = 0.0, error = 0.0;
    for (const int n : interface) mean += rest.found.u[at(n)][2] / static_cast<double>(interface.size());
    for (const Hexahedron& cell : scene.mesh.cells) {
      double shortened = 0.0;
      for (int I = 0; I < 8; ++I) shortened += (I < 4 ? 0.25 : -0.25) * rest.found.u[at(cell[at(I)])][2];
      error = std::max(error, std::abs(E * shortened / 0.25 / p - 1.0));
    }
    EXPECT_LT(error, limit) << below << " and " << above;
    EXPECT_NEAR(mean, -0.05, limit * 0.05);
    EXPECT_NEAR(rest.last.reactions.at("pair")[2], -2.0 * p, 1e-6 * p);
  }
}

/// cases/two-spheres.toml, with the upper ball turned by an angle (deg) about the z axis, and stiffer by a
/// factor. Half a turn about an axis in the plane that is turned by half of the angle does both turns.
Case balls(double angle, double stiffer) {
  Case description = read_case_file(std::filesystem::path(SANDGLASS_SOURCE) / "cases" / "two-spheres.toml");
  const double half = 0.5 * angle / 180.0 * std::numbers::pi;
  auto& bodies = std::get<std::vector<PlacedBody>>(description.mesh);
  bodies.back().turn = {180.0 * std::cos(half), 180.0 * std::sin(half), 0.0};
  CaseMaterial upper = description.materials.front();
  std::get<NeoHookean>(upper.law).young_modulus *= stiffer;
  upper.elements = "upper";
  description.materials.push_back(upper);
  return description;
}

/// The nodes of a set on the boundary.
std::vector<int> on_boundary(const Scene& scene, const std::string& set) {
  const auto outside = nodes_of(scene.boundary, scene.mesh.points.size());
  std::vector<int> nodes = scene.sets.at(set);
  std::erase_if(nodes, [&](int node) { return !outside[at(node)]; });
  return nodes;
}

/// The lower ball alone, under a rigid plane.
Case ball_on_plane() {
  Case description = balls(0.0, 1.0);
  std::get<std::vector<PlacedBody>>(description.mesh).pop_back();
  description.materials.pop_back();
  description.sets.pop_back();
  description.displacements.pop_back();
  description.forces.of<Contact>().clear();
  description.forces.of<Obstacle>() = {{.label = "plate", .set = "lower", .normal = {0.0, 0.0, -1.0}}};
  return description;
}

/// Two equal balls, whose plane of symmetry each feels as a rigid plane, answer as one of them on this plane:
/// the force errs by what the depths differ, times dF/dd = 1.5 F/d. Between meshes that do not match, chords
/// h = .044 m of the sphere lie off it by h^2 / (8 R) = 1.2e-4 m at most, by half of it in the mean, which is
/// .6 % of d and .9 % of F.
/// Hertz: with E* = 1 / ((1 - nu^2) (1/E + 1/E')) and R* = 1 m, F = 4/3 E* (R* d^3)^(1/2), 4 E* a^3 = 3 F R*
/// and p0 = 3 F / (2 pi a^2). The ends are held: there, half-spaces would move by 2 to 3 % of d, and the
/// balls are softer than half-spaces by about as much. A node has the force of its bilinear function: the
/// nodes' mean of r^2 is too high by h^2 / 3, and so is that of the function itself, over which p0 (1 - r^2 /
/// a^2)^(1/2) is p0 (1 - h^2 / (6 a^2)) in the mean.
TEST(RestingPair, answers_as_hertz_and_as_a_ball_on_a_plane) {
  const double d = 0.01, h = 0.0438, modulus = 1.40625e7 / (1.0 - 0.25 * 0.25);
  const Scene one = read_scene(ball_on_plane());
  const Rest on_plane = rest_of(Model(one, {"tl-mean-dilatation"}));
  const double F = on_plane.last.reactions.at("plate")[2];
  for (const auto& [angle, stiffer, limit] :
       {std::tuple{0.0, 1.0, 1e-3}, {45.0, 1.0, 0.01}, {45.0, 10.0, INFINITY}}) {
    const Scene scene = read_scene(balls(angle, stiffer));
    const Model model(scene, {"tl-mean-dilatation"});
    const Rest rest = rest_of(model);
    EXPECT_NEAR(rest.last.reactions.at("touch")[2], F, limit * std::abs(F));
    const Pressed pressed(
        model, rest.found.u, on_boundary(scene, "lower"),
        [](const Vector& X) { return std::hypot(X[0], X[1], X[2]); }, 0.25);
    const double E = modulus * stiffer / (1.0 + stiffer), hertz = 4.0 / 3.0 * E * std::pow(d, 1.5),
                 a = std::cbrt(0.75 * pressed.force / E),
                 p0 = 1.5 * pressed.force / (std::numbers::pi * a * a);
    EXPECT_NEAR(pressed.force, hertz, (stiffer == 1.0 ? 0.01 : 0.02) * hertz);
    EXPECT_NEAR(std::sqrt(2.5 * (pressed.square_arm - h * h / 3.0)), a, 0.02 * a);
    EXPECT_NEAR(pressed.middle / (h * h), p0 * (1.0 - h * h / (6.0 * a * a)), 0.03 * p0);
  }
}

/// A smooth ball on a block answers as if it had been pushed straight down, however far it slid there. Points
/// near an edge may stay on either of its triangles, whose normals differ by 10 degrees: forces differ by .12
/// %. If all points kept the triangles that they met on their way, it would be .57 %.
TEST(RestingPair, forgets_the_way_there) {
  const double R = 0.03, thickness = 0.03, fall = 0.003;
  Vector straight{};
  for (const double way : {0.0, 0.01, 0.02, 0.03}) {
    TwoBodies bodies(box({0.12, 0.06, thickness}, {12, 6, 3}),
                     moved(ball(R, 12), {0.0613 - way, 0.0308, thickness + R}),
                     NeoHookean{.young_modulus = 3000.0, .poisson_ratio = 0.45});
    bodies.sets["top"] =
        nodes_where(bodies.mesh.points, [&](const Vector& X) { return X[2] > thickness + 1.5 * R; });
    press(bodies, "lower", "upper", fall);
    bodies.description.displacements.back().value[0] = way;
    const Rest rest = rest_of(Model(bodies.scene(), {"tl-perturbation"}));
    const Vector& force = rest.last.reactions.at("pair");
    if (way == 0.0) straight = force;
    EXPECT_LT(distance(force, straight), 2e-3 * length(straight)) << way;
  }
}

/// A box of any size, turned and dragged on a larger one, which it may indent: whatever the number of load
/// levels, one answer, to what the choice of triangles on the way changes. Without friction, the force is
/// that of the pressure on faces that hardly tilt. Points of the lower box beside the edge of the upper one
/// do not touch its sides, which lean over them by a degree or two: they carried up to half of the load,
/// sideways, in 12 of 40 such scenes.
TEST(RestingPair, has_one_answer) {
  RandomGeometry random(47);
  for (int number = 0; number < 12; ++number) {
    const auto count = [&] { return static_cast<int>(random.uniform(2.0, 5.999)); };
    const double a = random.uniform(0.08, 0.13), h = random.uniform(0.04, 0.12),
                 angle = random.uniform(-1.5, 1.5);
    const double x = random.uniform(0.03, 0.07), y = random.uniform(0.03, 0.07),
                 z = random.uniform(0.03, 0.06);
    Mesh upper = moved(box({x, y, z}, {count(), count(), count()}), {-0.5 * x, -0.5 * y, h});
    for (Vector& X : upper.points) {
      X = {0.5 * a + std::cos(angle) * X[0] - std::sin(angle) * X[1],
           0.5 * a + std::sin(angle) * X[0] + std::cos(angle) * X[1], X[2]};
    }
    TwoBodies bodies(box({a, a, h}, {count(), count(), count()}), std::move(upper),
                     NeoHookean{.young_modulus = 3000.0, .poisson_ratio = random.uniform(0.0, 0.45)});
    press(bodies, "lower", "upper", random.uniform(0.1, 0.3) * z);
    Vector& displacement = bodies.description.displacements.back().value;
    displacement[0] = random.uniform(-0.3, 0.3) * x;
    displacement[1] = random.uniform(-0.3, 0.3) * y;
    std::optional<Vector> one;
    for (const int levels : {0, 3, 10, 30}) {
      bodies.description.relaxation.levels = levels;
      const Vector force = rest_of(Model(bodies.scene(), {"tl-perturbation"})).last.reactions.at("pair");
      if (!one) one = force;
      EXPECT_LT(distance(force, *one), 0.01 * length(*one)) << number << ", " << levels << " levels";
      EXPECT_LT(std::hypot(force[0], force[1]), 0.05 * std::abs(force[2]))
          << number << ", " << levels << " levels";
    }
  }
}

/// Bars that cross, with a gap: a step of the search that goes too far makes faces touch that are far from
/// each other, each behind the other. They are forgotten; kept, held ones gave forces of 26,000 N for 1.35 N.
TEST(RestingPair, forgets_far_faces) {
  for (const double gap : {0.0, 0.01}) {
    for (const int levels : {0, 1, 2, 10}) {
      TwoBodies bars(moved(box({0.1, 0.5, 1.0}, {1, 1, 2}), {-0.05, -0.25, -1.0}),
                     moved(box({0.5, 0.1, 1.0}, {1, 1, 2}), {-0.25, -0.05, gap}),
                     NeoHookean{.young_modulus = 1000.0, .poisson_ratio = 0.3});
      press(bars, "lower", "upper", gap + 0.05);
      bars.description.relaxation.levels = levels;
      const Rest rest = rest_of(Model(bars.scene(), {"tl-perturbation"}));
      EXPECT_NEAR(rest.last.reactions.at("pair")[2], -1.351, 0.002) << gap << ", " << levels;
      EXPECT_LT(rest.last.depth, 0.005) << gap << ", " << levels;
    }
  }
}

/// A simulation of a motion is moved to rest, to the same force as a static case, and hardly moves when it is
/// released: kinematic contact keeps the body apart as it is, but for the depth.
TEST(RestingPair, settles_a_motion) {
  const double fall = 0.05;
  TwoBodies moving = blocks(4, 0.0, fall);
  moving.description.forces.of<Contact>().front().method = Contact::Method::kinematic;
  const Rest rest = rest_of(Model(moving.scene(), {"tl-perturbation"}));
  const double F = rest.last.reactions.at("top")[2];
  Simulation<double> simulation(
      {moving.mesh.points, moving.mesh.cells, moving.sets},
      "[case]\nname = \"blocks\"\nrequirement = \"Blocks rest on each other.\"\nanswer = \"dynamic\"\n"
      "[material]\nlaw = \"neo-hookean\"\nyoung_modulus = 1e4\npoisson_ratio = 0.45\ndensity = 1000.0\n"
      "[[displacement]]\nset = \"foot\"\nvalue = [0.0, 0.0, 0.0]\n"
      "[[displacement]]\nset = \"top\"\nvalue = [0.0, 0.0, 0.0]\n"
      "[[contact]]\nname = \"pair\"\nset = \"under\"\nother = \"over\"\n[dynamics]\nduration = 1.0\n");
  simulation.move("top", {0.0, 0.0, -fall});
  simulation.settle();
  EXPECT_NEAR(simulation.reaction("pair")[2], F, 1e-6 * std::abs(F));
  simulation.advance(0.1);
  EXPECT_NEAR(simulation.reaction("pair")[2], F, 1e-3 * std::abs(F));
}

/// The motion of a static case has the contact of motions, whose stable step is the bodies': that of its
/// forces at rest is ignored, as no step is limited there.
TEST(RestingPair, moves_as_in_a_motion) {
  TwoBodies bodies = blocks(2, 0.01, 0.05);
  bodies.description.forces.of<Contact>().front().method = Contact::Method::kinematic;
  bodies.description.dynamics = {.duration = 1.0, .damping = 5.0};
  Scene moving = bodies.scene();
  moving.settings.quasi_static = false;
  moving = in_motion(std::move(moving));
  bodies.description.quasi_static = false;
  const Scene dynamic = bodies.scene();
  const auto end = [](const Scene& scene) {
    Observer silent;
    return integrate(Model(scene, {"tl-perturbation"}), silent).u;
  };
  EXPECT_EQ(end(moving), end(dynamic));
}

/// The same bits for any number of threads.
TEST(RestingPair, does_not_depend_on_threads) {
  const TwoBodies bodies = blocks(4, 0.1, 0.1);
  const Scene scene = bodies.scene();
  const auto u = [&](int threads) {
    return rest_of(Model(scene, {"tl-perturbation", {}, Precision::double_precision, threads})).found.u;
  };
  EXPECT_EQ(u(1), u(2));
}

/// An answer with one body in the other is refused; pressed surfaces are in each other by their depth.
TEST(RestingPair, does_not_answer_with_a_body_in_the_other) {
  const TwoBodies bodies = blocks(4, 0.1, 0.1);
  const Scene scene = bodies.scene();
  const auto fallen_by = [&](double way) {
    NodalField u(scene.mesh.points.size());
    for (const int node : scene.sets.at("upper")) u[at(node)][2] = -way;
    return u;
  };
  for (const double way : {0.0, 0.1, 0.11}) EXPECT_NO_THROW(require_apart(scene, fallen_by(way)));
  for (const double way : {0.2, 0.45}) EXPECT_THROW(require_apart(scene, fallen_by(way)), ComputationError);
}

/// What has no static equilibrium is refused by name.
TEST(RestingPair, names_what_is_wrong) {
  const auto message = [](const TwoBodies& bodies) {
    try {
      Recorder silent;
      relax(Model(bodies.scene(), {"tl-perturbation"}), silent);
    } catch (const InputError& error) {
      return std::string(error.what());
    }
    return std::string();
  };
  const auto expect = [&](const TwoBodies& bodies, const std::string& text) {
    EXPECT_NE(message(bodies).find(text), std::string::npos) << message(bodies);
    EXPECT_NE(message(bodies).find("allowed: "), std::string::npos);
  };
  TwoBodies folds = blocks(2, 0.0, 0.01), refined = folds;
  folds.description.forces.of<Contact>().front().other.clear();
  expect(folds, "[[contact]] has no static equilibrium: a surface touches itself in motions only");
  refined.description.refinements = {{.around = "foot", .layers = 1}};
  expect(refined, "[[contact]] has no static equilibrium on a mesh with [[refine]]");
  TwoBodies loose = blocks(2, 0.1, 0.01);  // nothing holds the upper block before it touches
  loose.description.displacements.pop_back();
  EXPECT_NE(message(loose).find("nothing holds"), std::string::npos) << message(loose);
}

}  // namespace
}  // namespace sandglass::verification::resting_pair_test
