/// Bodies that slide on each other, meet at edges and collide at random: no energy is gained, momentum is
/// kept, and nothing passes through without an error.

#include <gtest/gtest.h>

#include <numbers>

#include "base/error.hpp"
#include "mesh/edges.hpp"
#include "solve/central_difference.hpp"
#include "support/kept_run.hpp"
#include "support/random_scene.hpp"
#include "support/two_bodies.hpp"

namespace sandglass::verification {
namespace {

/// The largest energy (J) beyond what there was at the start and loads worked, and the largest energy.
struct Gain {
  double gained = 0.0, largest = 0.0;

  explicit Gain(const std::vector<HistoryRow>& rows) {
    const double start = total_energy(rows.front());
    for (const HistoryRow& row : rows) {
      // What a contact dissipates is never negative: it would hide a gain.
      const double losses = std::max(row.friction, 0.0) - row.friction;
      gained = std::max(gained, total_energy(row) + losses - row.external_work - start);
      largest = std::max(largest, total_energy(row));
    }
  }
};

/// A ball of hexahedra: a cube whose shells are blown up.
Mesh ball(double radius, int n) {
  return lattice({n, n, n}, [&](const Vector& s) {
    Vector x{2.0 * s[0] - 1.0, 2.0 * s[1] - 1.0, 2.0 * s[2] - 1.0};
    const double shell = std::max({std::abs(x[0]), std::abs(x[1]), std::abs(x[2])});
    if (shell == 0.0) return Vector{};
    const double sphere = radius * shell / length(x), cube = 0.6 * radius;
    const double round = shell * shell;
    for (double& one : x) one *= round * sphere + (1.0 - round) * cube;
    return x;
  });
}

TEST(Probe, slides_straight) {
  for (const auto method : both_methods)
    for (const double fraction : {0.5, 0.9}) {
      TwoBodies bodies(box({1.0, 1.0, 0.5}, {4, 4, 2}),
                       moved(box({0.6, 0.6, 0.3}, {3, 3, 2}), {0.17, 0.23, 0.5}),
                       NeoHookean{.young_modulus = 1e5, .poisson_ratio = 0.3});
      Case& d = bodies.description;
      d.displacements = {{"foot", {}}};
      d.forces.of<Gravity>() = {{{0.0, 0.0, -10.0}, {{0.0, 1.0}, {1.0, 1.0}}}};
      d.forces.of<Contact>() = {pair_of("upper", "lower", method)};
      d.dynamics.duration = 10.0;
      d.dynamics.step_fraction = fraction;
      d.dynamics.check_interval = 10;
      const Scene scene = bodies.scene();
      const Model model(scene, {"tl-perturbation"});
      Recorder recorder;
      const Motion motion = integrate(model, recorder);
      Vector way{};
      for (const int n : scene.sets.at("upper")) way = sum(way, 1.0 / 48.0, motion.u[at(n)]);
      const Gain gain(recorder.rows);
      fmt::print("{} {}: way {:.3g} {:.3g} {:.3g} gained {:.3g} of {:.3g} lost {:.3g} work {:.3g} depth {:.3g}\n",
                 int(method), fraction, way[0], way[1], way[2], gain.gained, gain.largest,
                 recorder.rows.back().friction, recorder.rows.back().external_work, recorder.rows.back().depth);
    }
}

TEST(Probe, ball_in_bowl) {
  for (const auto method : both_methods)
    for (const double fraction : {0.5, 0.9})
      for (const double way : {1.0, -1.0}) {
        Mesh bowl = lattice({10, 10, 2}, [&](const Vector& s) {
          const double x = 2.0 * s[0] - 1.0, y = 2.0 * s[1] - 1.0, r2 = x * x + y * y;
          return Vector{x, y, s[2] * (0.4 + way * 0.25 * (r2 - 1.0))};
        });
        TwoBodies bodies(std::move(bowl),
                         moved(ball(0.25, 4), {way > 0 ? 0.5 : 0.02, 0.0, way > 0 ? 0.55 : 0.92}),
                         NeoHookean{.young_modulus = 1e5, .poisson_ratio = 0.3});
        Case& d = bodies.description;
        d.displacements = {{"foot", {}}};
        d.forces.of<Gravity>() = {{{0.0, 0.0, -10.0}, {{0.0, 1.0}, {1.0, 1.0}}}};
        d.forces.of<Contact>() = {pair_of("upper", "lower", method)};
        d.dynamics.duration = 2.0;
        d.dynamics.step_fraction = fraction;
        d.dynamics.check_interval = 10;
        const Scene scene = bodies.scene();
        const Model model(scene, {"tl-perturbation"});
        Recorder recorder;
        const Motion motion = integrate(model, recorder);
        const Gain gain(recorder.rows);
        fmt::print("{} {} {}: gained {:.3g} of {:.3g} lost {:.3g} work {:.3g} kin {:.3g} depth {:.3g} x {:.3g}\n",
                   way, int(method), fraction, gain.gained, gain.largest, recorder.rows.back().friction,
                   recorder.rows.back().external_work, recorder.rows.back().kinetic, recorder.rows.back().depth,
                   motion.u.back()[0]);
      }
}

TEST(Probe, collides_at_random) {
  const long scenes = from_environment("SANDGLASS_SCENES", 100);
  RandomGeometry random(48);
  std::array<double, 2> worst{};
  std::array<int, 2> errors{};
  for (long number = 0; number < scenes; ++number) {
    const auto size = [&] { return random.uniform(0.3, 1.0); };
    const auto count = [&] { return static_cast<int>(random.uniform(2.0, 4.999)); };
    const auto body = [&]() -> Mesh {
      if (random.uniform(0.0, 1.0) > 0.5) {
        const double r = 0.5 * size();
        const int n = 2 * count();
        return moved(ball(r, std::min(n, 6)), {0.0, 0.0, 0.0});
      }
      const std::array<double, 3> sizes{size(), size(), size()};
      const std::array<int, 3> counts{count(), count(), count()};
      return moved(box(sizes, counts), {-0.5 * sizes[0], -0.5 * sizes[1], -0.5 * sizes[2]});
    };
    Mesh lower = body(), upper = body();
    double top = -INFINITY, bottom = INFINITY;
    for (const Vector& X : lower.points) top = std::max(top, X[2]);
    for (const Vector& X : upper.points) bottom = std::min(bottom, X[2]);
    upper = moved(std::move(upper),
                  {random.uniform(-0.4, 0.4), random.uniform(-0.4, 0.4), top - bottom + random.uniform(0.0, 0.1)});
    const double E = 1e4, waves = std::sqrt(E / 1000.0), speed = waves * random.uniform(0.01, 0.3);
    TwoBodies bodies(std::move(lower), std::move(upper),
                     NeoHookean{.young_modulus = E, .poisson_ratio = random.uniform(0.0, 0.49)});
    const auto method = both_methods[random.uniform(0.0, 1.0) > 0.5 ? 1 : 0];
    const double friction = random.uniform(-0.5, 0.5) > 0.0 ? random.uniform(0.1, 0.8) : 0.0;
    Case& d = bodies.description;
    Contact contact = pair_of("lower", "upper", method, friction);
    if (method == Contact::Method::penalty) contact.penalty = std::array{1.0, 5.0, 30.0}[at(static_cast<int>(random.uniform(0.0, 2.999)))];
    d.forces.of<Contact>() = {contact};
    d.velocities = {{.set = "upper",
                     .value = {random.uniform(-0.5, 0.5) * speed, random.uniform(-0.5, 0.5) * speed, -speed},
                     .spin = {random.uniform(-1.0, 1.0) * speed, random.uniform(-1.0, 1.0) * speed,
                              random.uniform(-1.0, 1.0) * speed}}};
    d.dynamics.duration = 1.0 / speed;
    d.dynamics.check_interval = 10;
    const std::string what = fmt::format("scene {}: method {} (penalty {}), friction {:.2f}, speed {:.3f} of waves",
                                         number, int(method), contact.penalty, friction, speed / waves);
    try {
      const Scene scene = bodies.scene();
      const Model model(scene, {"tl-perturbation"});
      Recorder recorder;
      const Motion motion = integrate(model, recorder);
      const Gain gain(recorder.rows);
      const double share = gain.gained / total_energy(recorder.rows.front());
      double depth = 0.0;
      for (const auto& row : recorder.rows) depth = std::max(depth, row.depth);
      if (share > 0.002)
        fmt::print("{}: gained {:.3g} %, lost {:.3g} %, depth {:.3g}, energy {:.4g} of {:.4g} repeated {}\n", what, 100 * share,
                   100 * recorder.rows.back().friction / total_energy(recorder.rows.front()),
                   depth / shortest_edge(scene.mesh), total_energy(recorder.rows.back()), total_energy(recorder.rows.front()), motion.repeated);
      worst[at(int(method))] = std::max(worst[at(int(method))], share);
    } catch (const std::exception& error) {
      ++errors[at(int(method))];
      fmt::print("{}: {}\n", what, error.what());
    }
  }
  fmt::print("worst kinematic {:.3g} penalty {:.3g}, errors {} {}\n", worst[0], worst[1], errors[0], errors[1]);
}

}  // namespace
}  // namespace sandglass::verification
