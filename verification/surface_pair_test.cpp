/// Deformable bodies that touch each other or themselves: momentum, closed forms, energies.

#include <gtest/gtest.h>

#include "solve/central_difference.hpp"
#include "support/two_bodies.hpp"

namespace sandglass::verification {
namespace {

/// The sums of m v and m x cross v.
struct Momentum {
  Vector linear{}, angular{};

  Momentum(const Scene& scene, const std::vector<double>& masses, const NodalField& u, const NodalField& v) {
    for (std::size_t n = 0; n < v.size(); ++n) {
      const Vector x = sum(scene.mesh.points[n], 1.0, u[n]);
      linear = sum(linear, masses[n], v[n]);
      angular = sum(angular, masses[n], cross(x, v[n]));
    }
  }
};

TEST(SurfacePair, explore_bars) {
  for (const double penalty : {0.1, 1.0, 10.0}) {
    const NeoHookean law{.young_modulus = 1000.0, .poisson_ratio = 0.0};
    TwoBodies bars(box({1.0, 1.0, 20.0}, {2, 2, 40}),
                   moved(box({1.0, 1.0, 20.0}, {3, 3, 40}), {0.0, 0.0, 20.4}), law, 0.1);
    bars.description.forces.of<Contact>() = {{.label = "pair", .set = "under", .other = "over", .penalty = penalty}};
    bars.description.velocities = {{.set = "lower", .value = {0.0, 0.0, 1.0}},
                                   {.set = "upper", .value = {0.0, 0.0, -1.0}}};
    bars.description.dynamics.duration = 0.8;
    bars.description.dynamics.check_interval = 1;
    const Scene scene = bars.scene();
    const Model model(scene, {"linear"});
    Recorder recorder;
    const Motion motion = integrate(model, recorder);
    double impulse = 0.0, plateau = 0.0, time = 0.0, most = 0.0, depth = 0.0;
    for (std::size_t n = 1; n < recorder.rows.size(); ++n) {
      const HistoryRow &row = recorder.rows[n], &before = recorder.rows[n - 1];
      const double f = -row.reactions.at("pair")[2], step = row.time - before.time;
      impulse += 0.5 * step * (f - before.reactions.at("pair")[2]);
      most = std::max(most, total_energy(row) / total_energy(recorder.rows.front()));
      depth = std::max(depth, row.depth);
      if (row.time > 0.24 && row.time < 0.56) plateau += step * f, time += step;
    }
    double v[2] = {0, 0}, m[2] = {0, 0};
    for (std::size_t n = 0; n < motion.v.size(); ++n) {
      const int k = n < bars.sets["lower"].size() ? 0 : 1;
      v[k] += model.masses()[n] * motion.v[n][2];
      m[k] += model.masses()[n];
    }
    fmt::print("penalty {} steps {} plateau {} impulse {} of 4, energy {} depth {} v {} {} end {}\n", penalty, motion.steps,
               plateau / time, impulse, most, depth, v[0] / m[0], v[1] / m[1],
               total_energy(recorder.rows.back()) / total_energy(recorder.rows.front()));
  }
}

TEST(SurfacePair, explore_momentum) {
  for (const double friction : {0.0, 0.5}) {
    for (const char* method : {"linear", "tl-perturbation", "tl-mean-dilatation", "tl-full"}) {
      const NeoHookean law{.young_modulus = 1e4, .poisson_ratio = 0.4};
      TwoBodies bodies(box({1.0, 1.0, 1.0}, {4, 4, 4}),
                       moved(box({0.8, 0.8, 0.8}, {3, 3, 3}), {0.33, 0.21, 1.02}), law);
      bodies.description.forces.of<Contact>() = {
          {.label = "pair", .set = "lower", .other = "upper", .friction = friction}};
      bodies.description.velocities = {{.set = "upper", .value = {-0.5, 0.3, -1.0}, .spin = {0.3, 0.5, 0.7}}};
      bodies.description.dynamics.duration = 1.5;
      bodies.description.dynamics.check_interval = 1;
      const Scene scene = bodies.scene();
      try {
        const Model model(scene, {method});
        Recorder recorder;
        const Motion motion = integrate(model, recorder);
        const Momentum before(scene, model.masses(), recorder.frames.front().u, recorder.frames.front().v),
            after(scene, model.masses(), motion.u, motion.v);
        double most = 0.0, depth = 0.0, force = 0.0;
        for (const HistoryRow& row : recorder.rows) {
          most = std::max(most, total_energy(row));
          depth = std::max(depth, row.depth);
          force = std::max(force, std::abs(row.reactions.at("pair")[2]));
        }
        fmt::print("{} {}: steps {} linear {} {} angular {} {} energy {} {} of {} friction {} depth {} force {}\n", method, friction,
                   motion.steps, distance(before.linear, after.linear), length(before.linear),
                   distance(before.angular, after.angular), length(before.angular), most,
                   total_energy(recorder.rows.back()), total_energy(recorder.rows.front()),
                   recorder.rows.back().friction, depth, force);
      } catch (const std::exception& error) {
        fmt::print("{}: {}\n", method, error.what());
      }
    }
  }
}

}  // namespace
}  // namespace sandglass::verification
