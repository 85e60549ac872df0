/// Two deformable bodies that touch in static equilibrium, without friction; static_friction_test.cpp has
/// that.

#include <gtest/gtest.h>

#include <map>
#include <numbers>

#include "base/error.hpp"
#include "sandglass/simulation.hpp"
#include "solve/health.hpp"
#include "support/pressed.hpp"
#include "support/static_answer.hpp"
#include "support/two_bodies.hpp"

namespace sandglass::verification {
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

/// A quarter of a ball of R = 2 m around its lowest (side 1) or highest (-1) point, the origin.
Mesh ball(int n, double side) {
  const double R = 2.0, size = 1.5, grading = 3.5;
  const auto graded = [&](double s) { return size * std::sinh(grading * s) / std::sinh(grading); };
  return lattice({n, n, n}, [&](const Vector& s) {
    const double x = graded(s[0]), y = graded(s[1]), depth = graded(side > 0.0 ? s[2] : 1.0 - s[2]),
                 r = std::min(std::hypot(x, y), size);
    return Vector{x, y, side * (depth + 0.5 * r * r / R * (1.0 - depth / size))};
  });
}

/// Balls pressed onto each other, of n and m elements along an edge; a force on a quarter, N.
struct Balls {
  TwoBodies bodies;
  Balls(int n, int m, double d)
      : bodies(ball(n, -1.0), ball(m, 1.0), NeoHookean{.young_modulus = 1.40625e7, .poisson_ratio = 0.25}) {
    const auto first = (n + 1) * (n + 1) * (n + 1);
    for (int k = 0; k < (n + 1) * (n + 1); ++k) bodies.sets["below"].push_back(n * (n + 1) * (n + 1) + k);
    for (int k = 0; k < (m + 1) * (m + 1); ++k) bodies.sets["above"].push_back(first + k);
    bodies.sets["left"] = plane(bodies.mesh.points, 0, 0.0);
    bodies.sets["front"] = plane(bodies.mesh.points, 1, 0.0);
    press(bodies, "below", "above", d);
    auto& held = bodies.description.displacements;
    held.push_back({"left", {}, {true, false, false}});
    held.push_back({"front", {}, {false, true, false}});
  }
};

/// Two equal balls, whose plane of symmetry each feels as a rigid plane, answer as one of them on this plane:
/// the force errs by what the depths differ, times dF/dd = 1.5 F/d. Between meshes that do not match, chords
/// h = .03 m of the sphere lie off it by h^2 / (8 R) = 6e-5 m, which is .6 % of d and .8 % of F.
/// Hertz: with E* = 7.5e6 Pa a = (3 F R / (8 E*))^(1/3), and p0 = 3 F / (2 pi a^2) in the middle.
TEST(RestingPair, answers_as_a_ball_on_a_plane) {
  const double R = 2.0, modulus = 7.5e6, d = 0.01;
  const int n = 14;
  Balls one(n, 1, d);
  auto& held = one.bodies.description.displacements;
  held[1] = {"upper", {0.0, 0.0, 1.0}};
  one.bodies.description.forces.of<Contact>().clear();
  one.bodies.description.forces.of<Obstacle>() = {
      {.label = "plate", .set = "below", .normal = {0.0, 0.0, -1.0}, .displacement = {0.0, 0.0, -0.5 * d}}};
  const Rest on_plane = rest_of(Model(one.bodies.scene(), {"tl-mean-dilatation"}));
  const double F = on_plane.last.reactions.at("plate")[2];
  for (const auto& [m, limit] : {std::pair{n, 1e-3}, {n - 2, 0.01}}) {
    const Balls balls(n, m, d);
    const Scene scene = balls.bodies.scene();
    const Model model(scene, {"tl-mean-dilatation"});
    const Rest rest = rest_of(model);
    EXPECT_NEAR(rest.last.reactions.at("pair")[2], F, limit * std::abs(F));
    EXPECT_LT(rest.found.steps, 3 * on_plane.found.steps);
    const Pressed pressed(
        model, rest.found.u, scene.sets.at("below"), [](const Vector& X) { return std::hypot(X[0], X[1]); },
        0.2);
    const double a = std::cbrt(3.0 * 4.0 * pressed.force * R / (8.0 * modulus)),
                 p0 = 1.5 * 4.0 * pressed.force / (std::numbers::pi * a * a),
                 h = 1.5 * std::sinh(3.5 / n) / std::sinh(3.5);
    EXPECT_NEAR(std::sqrt(2.5 * pressed.square_arm), a, 0.02 * a);
    EXPECT_NEAR(pressed.middle / (0.25 * h * h), p0, 0.03 * p0);
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
}  // namespace sandglass::verification
