/// Published and closed answers of two deformable bodies: bars that collide, the patch test of contact, two
/// spheres of Hertz, a wedge that slides with friction.

#include <gtest/gtest.h>

#include <numbers>
#include <numeric>

#include "sandglass/simulation.hpp"
#include "solve/central_difference.hpp"
#include "support/graded.hpp"
#include "support/pressed.hpp"
#include "support/two_bodies.hpp"

namespace sandglass::verification::surface_pair_published_test {
namespace {

/// Two equal bars collide (FrontISTR's tworods), with meshes that do not match: the stress rho c v acts from
/// the time gap / 2v on for 2 L / c, then their velocities are exchanged. The scheme rings, so that means
/// count, and what rings is not returned: a percent of the impulse. The kinematic method takes the share of
/// the kinetic energy that is in the nodes that meet, a 120th: with 40 elements in a row its impulse errs by
/// 1.24 %. Energy never grows; the penalty lets go at the end of a step, too late by up to one, and gains
/// 1e-4; a soft one does not.
TEST(SurfacePair, lets_bars_exchange_their_velocities) {
  const double L = 20.0, gap = 0.4, E = 1000.0, rho = 0.1, v = 1.0, c = std::sqrt(E / rho),
               stress = rho * c * v, touch = 0.5 * gap / v, release = touch + 2.0 * L / c, mass = rho * L;
  for (const double penalty : {0.0, 1.0, Contact{}.penalty}) {  // 0: the kinematic method
    const auto method = penalty > 0.0 ? Contact::Method::penalty : Contact::Method::kinematic;
    TwoBodies bars(box({1.0, 1.0, L}, {2, 2, 60}), moved(box({1.0, 1.0, L}, {3, 3, 60}), {0.0, 0.0, L + gap}),
                   NeoHookean{.young_modulus = E, .poisson_ratio = 0.0}, rho);
    Contact contact = pair_of("under", "over", method);
    if (penalty > 0.0) contact.penalty = penalty;
    bars.description.forces.of<Contact>() = {contact};
    bars.description.velocities = {{.set = "lower", .value = {0.0, 0.0, v}},
                                   {.set = "upper", .value = {0.0, 0.0, -v}}};
    bars.description.dynamics.duration = 1.3 * release;
    bars.description.dynamics.check_interval = 1;
    const Scene scene = bars.scene();
    const Model model(scene, {"linear"});
    Recorder recorder;
    const Motion motion = integrate(model, recorder);
    const double energy = total_energy(recorder.rows.front()), margin = 0.1 * (release - touch);
    double impulse = 0.0, plateau = 0.0, time = 0.0;
    for (std::size_t n = 1; n < recorder.rows.size(); ++n) {
      const HistoryRow& row = recorder.rows[n];
      const double force = -row.reactions.at("pair")[2], step = row.time - recorder.rows[n - 1].time;
      EXPECT_LE(total_energy(row), (1.0 + (penalty > 1.0 ? 1e-3 : 1e-9)) * energy);
      EXPECT_GE(force, 0.0);
      if (row.time < touch) {
        EXPECT_EQ(force, 0.0);
      }
      impulse += step * force;
      if (row.time < touch + margin || row.time > release - margin) continue;
      plateau += step * force;
      time += step;
    }
    EXPECT_NEAR(plateau / time, stress, 0.01 * stress);
    EXPECT_NEAR(impulse, 2.0 * mass * v, 0.01 * 2.0 * mass * v);
    EXPECT_LT(recorder.rows.back().friction, 1.1 / 120.0 * energy);
    double momentum = 0.0;
    for (const int node : bars.sets.at("lower")) momentum += model.masses()[at(node)] * motion.v[at(node)][2];
    EXPECT_NEAR(momentum, -mass * v, 0.02 * mass * v);
  }
}

/// The patch test of contact (SSNP121 of Code_Aster): a pressure on two plates whose meshes do not match. The
/// kinematic method passes it, as the plane interface is a solution that separates all points: what is left
/// has not been damped yet. By the penalty, forces of points at Simpson's places on one mesh meet the other,
/// where they do not see elements end: stresses of elements err by up to a percent here, where nodes alone
/// err by 6 % (published). They are exact where all edges of one mesh meet edges or middles of the other.
TEST(SurfacePair, passes_the_patch_test) {
  struct Meshes {
    int below, above;
    double limit_of_penalty;
  };
  for (const auto method : both_methods) {
    for (const auto& [below, above, limit_of_penalty] :
         {Meshes{4, 4, 1e-3}, {6, 2, 1e-3}, {4, 3, 0.01}, {3, 4, 0.01}, {16, 12, 0.01}}) {
      const double E = 2e6, p = 1e5, limit = method == Contact::Method::penalty ? limit_of_penalty : 5e-4;
      TwoBodies plates(box({2.0, 1.0, 1.0}, {below, 1, 4}),
                       moved(box({2.0, 1.0, 1.0}, {above, 2, 4}), {0.0, 0.0, 1.0}),
                       NeoHookean{.young_modulus = E, .poisson_ratio = 0.0});
      Case& d = plates.description;
      d.forces.of<Contact>() = {pair_of("under", "over", method)};
      d.forces.of<Pressure>() = {{.set = "top", .value = p, .curve = {{0.0, 0.05}, {0.0, 1.0}}}};
      d.displacements = {{"foot", {}}, {"top", {}, {true, true, false}}};
      d.dynamics.duration = 1.0;
      d.dynamics.damping = 60.0;
      const Scene scene = plates.scene();
      Recorder recorder;
      const Motion motion = integrate(Model(scene, {"linear"}), recorder);
      const auto& interface = plates.sets.at("under");
      double mean = 0.0, error = 0.0;
      for (const int n : interface) mean += motion.u[at(n)][2] / static_cast<double>(interface.size());
      for (const Hexahedron& cell : scene.mesh.cells) {
        double shortened = 0.0;
        for (int I = 0; I < 8; ++I) shortened += (I < 4 ? 0.25 : -0.25) * motion.u[at(cell[at(I)])][2];
        error = std::max(error, std::abs(E * shortened / 0.25 / p - 1.0));
      }
      EXPECT_LT(error, limit) << below << " and " << above;
      EXPECT_NEAR(mean, -0.05, limit * 0.05);
      EXPECT_NEAR(recorder.rows.back().reactions.at("pair")[2], -2.0 * p, 1e-4 * p);
    }
  }
}

/// Hertz: two equal spheres of R = 2 m, of different meshes, E* = 7.5e6 Pa, pressed by d = 0.01 m: a = 0.1 m,
/// five elements here, F = 1e4 N, and in the middle p0 = 3 F / (2 pi a^2). The bodies are 100 a wide and
/// high: half-spaces would move by 1 % of d at their ends. The forces at both ends and between them are the
/// same when the motion is over.
TEST(SurfacePair, meets_the_closed_form_of_two_spheres) {
  const double R = 2.0, E = 1.40625e7, d = 0.01, a = 0.1, F = 1e4, p0 = 1.5 * F / (std::numbers::pi * a * a);
  const Graded graded{10.0, 6.0};
  const auto sphere = [&](int edges, double side) {
    return lattice({edges, edges, edges}, [&](const Vector& s) {
      const double x = graded(s[0]), y = graded(s[1]), depth = graded(side > 0.0 ? s[2] : 1.0 - s[2]),
                   bulge = 0.5 / R * std::min(x * x + y * y, 1.0);
      return Vector{x, y, side * (depth + bulge * (1.0 - depth / graded.size))};
    });
  };
  const int n = 16, m = 14;
  Mesh lower = sphere(n, -1.0), upper = sphere(m, 1.0);
  const auto first = static_cast<int>(lower.points.size());
  TwoBodies balls(std::move(lower), std::move(upper), NeoHookean{.young_modulus = E, .poisson_ratio = 0.25},
                  E);
  const auto& points = balls.mesh.points;
  const auto layer = [](int begin, int edges) {
    std::vector<int> nodes(at((edges + 1) * (edges + 1)));
    std::iota(nodes.begin(), nodes.end(), begin);
    return nodes;
  };
  balls.sets["below"] = layer(n * (n + 1) * (n + 1), n);
  balls.sets["above"] = layer(first, m);
  balls.sets["left"] = plane(points, 0, 0.0);
  balls.sets["front"] = plane(points, 1, 0.0);
  Case& c = balls.description;
  c.displacements = {{"foot", {}},
                     {"top", {0.0, 0.0, -d}},
                     {"left", {}, {true, false, false}},
                     {"front", {}, {false, true, false}}};
  c.forces.of<Contact>() = {pair_of("below", "above", Contact::Method::kinematic)};
  c.dynamics.duration = 160.0;
  c.dynamics.ramp_time = 64.0;
  c.dynamics.damping = 0.2;
  const Scene scene = balls.scene();
  const Model model(scene, {"tl-enhanced"});
  Recorder recorder;
  const Motion motion = integrate(model, recorder);
  const auto& reactions = recorder.rows.back().reactions;
  EXPECT_NEAR(4.0 * reactions.at("foot")[2], F, 0.01 * F);
  EXPECT_NEAR(4.0 * reactions.at("pair")[2], -F, 0.01 * F);
  EXPECT_NEAR(4.0 * reactions.at("top")[2], -F, 0.01 * F);
  const auto radius = [](const Vector& X) { return std::hypot(X[0], X[1]); };
  const auto& surface = scene.sets.at("below");
  const Pressed ball(model, motion.u, surface, radius, 2.0 * a);
  EXPECT_NEAR(4.0 * ball.force, F, 0.01 * F);
  EXPECT_NEAR(std::sqrt(2.5 * ball.square_arm), a, 0.02 * a);
  const Pressed middle(model, motion.u, surface, radius, a / 2.0);
  double expected = 0.0;  // of p0 (1 - r^2/a^2)^(1/2) at the nodes
  for (const int node : surface) {
    const Vector& X = points[at(node)];
    if (radius(X) > a / 2.0) continue;
    double area = 1.0;
    for (const double x : {X[0], X[1]}) area *= (x > 0.0 ? 1.0 : 0.5) * graded.width_at(x, n);
    expected += area * p0 * std::sqrt(1.0 - radius(X) * radius(X) / (a * a));
  }
  EXPECT_NEAR(middle.force, expected, 0.03 * expected);
}

/// The upper wedge of CGS-4 on the lower one, with `slope` and the given contact; it is pushed uphill.
Simulation<double> wedge(double slope, double friction, Contact::Method method, double modulus) {
  const auto interface = [slope](double x) { return 0.7 + slope * x; };
  Mesh mesh = lattice({12, 3, 1}, [&](const Vector& s) {
    const double x = 6.0 * s[0];
    return Vector{x, interface(x) * s[1], s[2]};
  });
  const auto first = mesh.points.size();
  const Mesh upper = lattice({9, 3, 1}, [&](const Vector& s) {
    const double x = 1.0 + 4.0 * s[0], low = interface(x);
    return Vector{x, low + (2.0 - low) * s[1], s[2]};
  });
  mesh.points.insert(mesh.points.end(), upper.points.begin(), upper.points.end());
  for (Hexahedron cell : upper.cells) {
    for (int& node : cell) node += static_cast<int>(first);
    mesh.cells.push_back(cell);
  }
  std::map<std::string, std::vector<int>> sets;
  for (std::size_t n = 0; n < mesh.points.size(); ++n) {
    const auto& [x, y, z] = mesh.points[n];
    const bool is_upper = n >= first, at_interface = std::abs(y - interface(x)) < 1e-9;
    const auto add = [&](const char* set, bool is_in) {
      if (is_in) sets[set].push_back(static_cast<int>(n));
    };
    add("all", true);
    add("base", !is_upper && y == 0.0);
    add("lower", !is_upper && at_interface);
    add("upper", is_upper && at_interface);
    add("top", is_upper && y > 2.0 - 1e-9);
    add("pushed", is_upper && !at_interface && x < 1.0 + 1e-9);
  }
  const std::string held = "value = [0.0, 0.0, 0.0]\ncomponents = ";
  return {{mesh.points, mesh.cells, sets},
          "[case]\nname = \"cgs-4\"\nrequirement = \"A wedge slides uphill.\"\nanswer = \"dynamic\"\n"
          "[material]\nlaw = \"neo-hookean\"\nyoung_modulus = " +
              fmt::format("{:.17g}", modulus) +
              "\npoisson_ratio = 0.0\ndensity = 0.1\n"
              "[[displacement]]\nset = \"base\"\n" +
              held + "\"xy\"\n[[displacement]]\nset = \"all\"\n" + held +
              "\"z\"\n[[displacement]]\nset = \"pushed\"\n" + held +
              "\"x\"\n[[force]]\nset = \"top\"\ntotal = [0.0, -40.0, 0.0]\ntimes = [0.0, 2.0]\n"
              "factors = [0.0, 1.0]\n[[contact]]\nname = \"interface\"\nset = \"lower\"\n"
              "other = \"upper\"\n" +
              fmt::format("method = \"{}\"\nfriction = {}\n[dynamics]\nduration = 1.0\ndamping = 20.0\n",
                          words_of(method)[static_cast<std::size_t>(method)], friction)};
}

/// NAFEMS CGS-4: F / G = (tan a + mu) / (1 - mu tan a). The wedge is fast until all of the interface slips,
/// then so slow that damping adds at most 1e-3 of F. Found within .06 %, as FrontISTR, by the elastic tilt of
/// the interface; a penalty of 10 errs by .19 %, of 1 by .95 %. Before all of it slips, F is too small. If
/// points oscillate from step to step, kinematic contact loses 1 to 3 % of the force. Whether they do may be
/// a matter of rounding, hence nine motions that differ by it: if points that touch also return half of their
/// speed, every second one fails.
TEST(SurfacePair, pushes_a_wedge_uphill_with_the_published_force) {
  constexpr double slope = 0.1, weight = 40.0;
  for (const auto method : both_methods) {
    for (int n = 0; n < (method == Contact::Method::kinematic ? 12 : 4); ++n) {
      const double friction = n < 4 ? 0.1 * n : 0.1, rounding = 1e-13 * n;
      Simulation<double> simulation = wedge(slope, friction, method, 1100.0 * (1.0 + rounding));
      simulation.advance(3.0);
      simulation.move("pushed", {0.15, 0.0, 0.0});
      simulation.advance(3.0);
      simulation.move("pushed", {0.1515, 0.0, 0.0});
      simulation.advance(3.0);
      const double exact = (slope + friction) / (1.0 - friction * slope);
      EXPECT_NEAR(simulation.reaction("pushed")[0] / weight, exact, 0.002 * exact) << friction;
    }
  }
}

}  // namespace
}  // namespace sandglass::verification::surface_pair_published_test
