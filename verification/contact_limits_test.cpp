/// What contact cannot follow is an error, with the place, and not a wrong answer: bodies and obstacles that
/// overlap at the start, that pass through each other, and nodes that an obstacle cannot push.

#include <gtest/gtest.h>

#include <numbers>
#include <numeric>

#include "base/error.hpp"
#include "solve/central_difference.hpp"
#include "support/two_bodies.hpp"

namespace sandglass::verification::contact_limits_test {
namespace {

constexpr double modulus = 1e4, density = 1000.0;
const double wave_speed = std::sqrt(modulus / density);

NeoHookean law() {
  return {.young_modulus = modulus, .poisson_ratio = 0.3};
}

/// The message of an error; empty if there is none.
template <class Error, class Make>
std::string message_of(const Make& make) {
  try {
    make();
  } catch (const Error& error) {
    return error.what();
  }
  return "";
}

void expect_in(const std::string& all, const std::string& text) {
  EXPECT_NE(all.find(text), std::string::npos) << "'" << all << "' has no '" << text << "'";
}

/// Bodies that overlap by more than an edge, one within the other, and only by the faces of open surfaces.
/// Bodies that touch, face to face or in a cavity, do not overlap.
TEST(ContactLimits, refuses_bodies_that_overlap) {
  const auto message = [](Mesh lower, Mesh upper, const Contact& contact) {
    TwoBodies bodies(std::move(lower), std::move(upper), law());
    bodies.description.forces.of<Contact>() = {contact};
    return message_of<InputError>([&] { bodies.scene(); });
  };
  for (const auto method : both_methods) {
    const Contact all = pair_of("lower", "upper", method), faces = pair_of("under", "over", method);
    const Mesh cube = box({1.0, 1.0, 1.0}, {4, 4, 4});
    const std::string overlap =
        "is within the other body at the start; allowed: bodies that do not intersect";
    expect_in(message(cube, moved(cube, {0.1, 0.07, 0.5}), faces), overlap);
    expect_in(message(cube, moved(cube, {0.1, 0.07, 0.5}), all), overlap);
    const Mesh small = moved(box({0.1, 0.1, 0.1}, {2, 2, 2}), {0.45, 0.45, 0.45});
    expect_in(message(cube, small, all), overlap);
    expect_in(message(small, cube, all), overlap);
    expect_in(message(cube, cube, all), overlap);
    EXPECT_EQ(message(cube, moved(cube, {0.0, 0.0, 1.0}), all), "");
    EXPECT_EQ(message(cube, moved(cube, {0.25, 0.5, 1.0}), all), "");
    Mesh hollow = box({1.0, 1.0, 1.0}, {5, 5, 5});
    std::erase_if(hollow.cells, [&](const Hexahedron& cell) {
      return std::ranges::all_of(cell, [&](int n) {
        const Vector& X = hollow.points[at(n)];
        return std::ranges::all_of(X, [](double x) { return x > 0.1 && x < 0.9; });
      });
    });
    EXPECT_EQ(message(hollow, moved(box({0.6, 0.6, 0.6}, {3, 3, 3}), {0.2, 0.2, 0.2}), all), "");
  }
}

/// A ring that does not close, and one whose ends are within it.
TEST(ContactLimits, refuses_a_body_that_overlaps_itself) {
  const auto message = [](double turns) {
    Mesh ring = lattice({40, 2, 2}, [&](const Vector& s) {
      const double angle = 2.0 * std::numbers::pi * turns * s[0], r = 1.0 - 0.2 * s[1];
      return Vector{r * std::cos(angle), r * std::sin(angle), 0.2 * s[2]};
    });
    Case c = plain_case(law());
    c.quasi_static = false;
    c.forces.of<Contact>() = {{.label = "ring", .set = "ends"}};
    NodeSets sets;
    for (int node = 0; at(node) < ring.points.size(); ++node)
      if (node % 41 == 0 || node % 41 == 40) sets["ends"].push_back(node);
    return message_of<InputError>([&] { make_scene(c, std::move(ring), std::move(sets)); });
  };
  EXPECT_EQ(message(0.9), "");
  expect_in(message(1.1), "is within the body itself at the start; allowed: bodies that do not intersect");
}

/// No node is within a tool that is wholly within the body.
TEST(ContactLimits, refuses_a_tool_within_a_body) {
  for (const auto shape : {Obstacle::Shape::sphere, Obstacle::Shape::capsule, Obstacle::Shape::box}) {
    const auto message = [&](const Vector& point) {
      Column block({1.0, 1.0, 1.0}, {2, 2, 2}, law());
      Obstacle tool{.label = "tool", .set = "top", .shape = shape, .point = point};
      if (shape == Obstacle::Shape::box) tool.half_sizes = {0.1, 0.1, 0.1};
      if (shape != Obstacle::Shape::box) tool.radius = 0.1;
      if (shape == Obstacle::Shape::capsule) tool.end = sum(point, 1.0, {0.1, 0.0, 0.0});
      block.description.forces.of<Obstacle>() = {tool};
      return message_of<InputError>([&] { block.scene(); });
    };
    expect_in(message({0.3, 0.3, 0.7}), "its point (0.3, 0.3, 0.7) m is within the body at the start");
    EXPECT_EQ(message({0.3, 0.3, 1.2}), "");
  }
}

/// A plane that presses a side, from the right and from the wrong side, touching or with a gap; its set may
/// be the whole surface.
TEST(ContactLimits, refuses_a_plane_that_looks_away_from_the_body) {
  for (const auto& [set, z, normal, refused] : {std::tuple{"top", 1.0, -1.0, false},
                                                {"top", 1.1, -1.0, false},
                                                {"top", 1.0, 1.0, true},
                                                {"top", 0.5, 1.0, true},
                                                {"foot", 0.0, 1.0, false},
                                                {"foot", 0.0, -1.0, true},
                                                {"all", 1.0, -1.0, false},
                                                {"side", 0.0, 1.0, false}}) {
    Column block({1.0, 1.0, 1.0}, {2, 2, 2}, law());
    auto& all = block.sets["all"];
    all.resize(block.mesh.points.size());
    std::iota(all.begin(), all.end(), 0);
    block.description.forces.of<Obstacle>() = {{.label = "tool",
                                                .set = set,
                                                .shape = Obstacle::Shape::plane,
                                                .point = {0.5, 0.5, z},
                                                .normal = {0.0, 0.0, normal}}};
    const std::string said = message_of<InputError>([&] { block.scene(); });
    SCOPED_TRACE(fmt::format("{} {} {}: {}", set, z, normal, said));
    if (refused)
      expect_in(said, "the body is behind the plane");
    else
      EXPECT_EQ(said, "");
  }
}

std::string run(const Scene& scene) {
  return message_of<ComputationError>([&] {
    Recorder silent;
    integrate(Model(scene, {"tl-perturbation"}), silent);
  });
}

/// A body that moves by more than an edge in a step passes the other's surface between two steps; one that
/// flies past at this speed, or both together, are no error.
TEST(ContactLimits, reports_fast_bodies) {
  for (const auto method : both_methods) {
    const auto thrown = [&](double aside, bool together) {
      TwoBodies bodies(box({1.0, 1.0, 0.5}, {4, 4, 2}),
                       moved(box({1.0, 1.0, 0.5}, {3, 3, 2}), {aside, 0.0, 0.51}), law());
      bodies.description.forces.of<Contact>() = {pair_of("lower", "upper", method)};
      bodies.description.velocities = {
          {.set = together ? "" : "upper", .value = {0.0, 0.0, -10.0 * wave_speed}}};
      bodies.description.dynamics.duration = 1.0 / wave_speed;
      bodies.description.dynamics.check_interval = 1;
      return run(bodies.scene());
    };
    expect_in(thrown(0.0, false), "contact 'pair': node");
    EXPECT_EQ(thrown(3.0, false), "");
    EXPECT_EQ(thrown(0.0, true), "");
  }
}

/// The same for a node and a small obstacle, and for a ball that is pressed deeper than it can push back
/// from: beyond its centre it would pull.
TEST(ContactLimits, reports_nodes_that_pass_an_obstacle) {
  Column block({1.0, 1.0, 1.0}, {4, 4, 4}, law());
  block.description.quasi_static = false;
  block.description.dynamics.check_interval = 1;
  block.description.dynamics.duration = 0.5 / wave_speed;
  block.description.velocities = {{.set = "", .value = {0.0, 0.0, -0.5 * wave_speed}}};
  Obstacle pearl{
      .label = "pearl", .set = "foot", .shape = Obstacle::Shape::sphere, .point = {0.5, 0.5, -0.021}};
  pearl.radius = 0.02;
  block.description.forces.of<Obstacle>() = {pearl};
  expect_in(run(block.scene()), "contact 'pearl': node");
  Column pressed({1.0, 1.0, 0.5}, {4, 4, 2}, law());
  pressed.description.quasi_static = false;
  pressed.description.displacements = {{"foot", {}}};
  pressed.description.dynamics.duration = 2.0;
  for (const double deep : {0.1, 0.3}) {
    Obstacle ball{.label = "ball", .set = "top", .shape = Obstacle::Shape::sphere, .point = {0.5, 0.5, 0.61}};
    ball.radius = 0.1;
    ball.displacement = {0.0, 0.0, -deep};
    ball.penalty = deep > 0.2 ? 0.01 : 30.0;
    ball.method = Obstacle::Method::penalty;
    pressed.description.forces.of<Obstacle>() = {ball};
    const std::string message = run(pressed.scene());
    EXPECT_EQ(message.find("contact 'ball': node") != std::string::npos, deep > 0.2) << message;
  }
}

/// An obstacle does not push nodes that are held or driven: what holds them would bear its force, without any
/// answer of the body. Only the foot is within this plane.
TEST(ContactLimits, leaves_held_nodes_alone) {
  for (const auto method : {Obstacle::Method::penalty, Obstacle::Method::kinematic}) {
    Column block({1.0, 1.0, 1.0}, {2, 2, 2}, law());
    block.description.quasi_static = false;
    block.description.displacements = {{"foot", {}}};
    block.description.dynamics.duration = 1.0;
    Obstacle plane = ground();
    plane.set = "side";
    plane.point = {0.0, 0.0, -0.1};
    plane.displacement = {0.0, 0.0, 0.3};
    plane.method = method;
    block.description.forces.of<Obstacle>() = {plane};
    const Scene scene = block.scene();
    Recorder recorder;
    integrate(Model(scene, {"tl-perturbation"}), recorder);
    EXPECT_EQ(recorder.rows.back().reactions.at("ground"), Vector{});
    EXPECT_EQ(recorder.rows.back().strain, 0.0);
    plane.set = "foot";
    block.description.forces.of<Obstacle>() = {plane};
    expect_in(message_of<InputError>([&] { block.scene(); }), "all nodes of set 'foot' are held or driven");
  }
}

/// Friction that drives what slides is none, whether a table or a formula says so.
TEST(ContactLimits, refuses_negative_friction) {
  const auto broken = [](double last) {
    const auto rule = Contact{.label = "pair", .curve = {{0.0, 1.0}, {1.0, last}}}.broken_rule();
    return rule ? rule->parameter : "";
  };
  EXPECT_EQ(broken(0.0), "");
  EXPECT_EQ(broken(-0.1), "factors");
  TwoBodies bodies(box({1.0, 1.0, 0.5}, {1, 1, 1}), moved(box({1.0, 1.0, 0.5}, {1, 1, 1}), {0.0, 0.0, 0.5}),
                   NeoHookean{.young_modulus = 1e4});
  Contact contact = pair_of("under", "over", Contact::Method::kinematic, 0.3);
  contact.curve.formula = Formula("1 - 100 * t");
  bodies.description.forces.of<Contact>() = {contact};
  bodies.description.dynamics.duration = 0.1;
  Observer silent;
  const Scene scene = bodies.scene();
  expect_in(message_of<InputError>([&] { integrate(Model(scene, {"tl-perturbation"}), silent); }),
            "contact 'pair': the factor of the friction becomes -");
}

/// An obstacle whose place is forgotten would be at the origin.
TEST(ContactLimits, places_no_obstacle_by_default) {
  Obstacle tool{.label = "tool", .set = "top", .shape = Obstacle::Shape::capsule, .radius = 0.1};
  const auto broken = [&] {
    const auto rule = tool.broken_rule();
    return rule ? rule->parameter : "";
  };
  EXPECT_EQ(broken(), "point");
  tool.point = {};
  EXPECT_EQ(broken(), "end");
  tool.end = {0.0, 0.0, 1.0};
  EXPECT_EQ(broken(), "");
  tool.shape = Obstacle::Shape::sphere;
  EXPECT_EQ(broken(), "end");
}

}  // namespace
}  // namespace sandglass::verification::contact_limits_test
