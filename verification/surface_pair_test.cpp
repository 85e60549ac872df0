/// Deformable bodies that touch each other or themselves: momentum, closed forms, energies.

#include <gtest/gtest.h>

#include <numbers>
#include <numeric>

#include "mesh/edges.hpp"
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

TEST(SurfacePair, explore_patch) {
  for (const auto& [below, above] : {std::pair{4, 3}, {3, 4}, {4, 4}, {5, 3}, {8, 6}, {6, 2}, {16, 12}}) {
    const double E = 2e6, p = 1e5;
    const NeoHookean law{.young_modulus = E, .poisson_ratio = 0.0};
    TwoBodies plates(box({2.0, 1.0 , 1.0}, {below, 1, 4}),
                     moved(box({2.0, 1.0, 1.0}, {above, 2, 4}), {0.0, 0.0, 1.0}), law);
    Case& d = plates.description;
    plates.sets["all"].resize(plates.mesh.points.size());
    std::iota(plates.sets["all"].begin(), plates.sets["all"].end(), 0);
    d.forces.of<Contact>() = {{.label = "pair", .set = "under", .other = "over"}};
    d.forces.of<Pressure>() = {{.set = "top", .value = p}};
    d.forces.of<Pressure>().front().curve = {{0.0, 0.05}, {0.0, 1.0}};
    d.displacements = {{"foot", {}}, {"top", {}, {true, true, false}}};
    d.dynamics.duration = 1.0;
    d.dynamics.damping = 60.0;
    const Scene scene = plates.scene();
    Recorder recorder;
    const Motion motion = integrate(Model(scene, {"linear"}), recorder);
    double off = 0.0, stress = 0.0, mean_off=0;
    for (const int n : plates.sets["under"]) off = std::max(off, std::abs(motion.u[at(n)][2] + 0.05)), mean_off += motion.u[at(n)][2] / static_cast<double>(plates.sets["under"].size());
    for (const Hexahedron& cell : plates.mesh.cells) {
      double low = 0.0, high = 0.0, z = 0.0;
      for (int I = 0; I < 8; ++I) {
        (I < 4 ? low : high) += 0.25 * motion.u[at(cell[at(I)])][2];
        z += 0.125 * plates.mesh.points[at(cell[at(I)])][2];
      }
      stress = std::max(stress, std::abs(E * (high - low) / 0.25 / p + 1.0));
    }
    fmt::print("{} {}: stress off by {}, interface by {} mean {}, depth {} force {} steps {}\n", below, above, stress, off / 0.05, mean_off,
               recorder.rows.back().depth, recorder.rows.back().reactions.at("pair")[2], motion.steps);
  }
}

TEST(SurfacePair, explore_fold) {
  const double L = 1.0, t = 0.2, gap = 0.1, R = 0.5 * (t + gap), bend = std::numbers::pi * R, way = 2.0 * L + bend;
  for (const double penalty : {0.0, 1.0}) for (const double friction : {0.0, 0.3}) {
    Column strip({1.0, 1.0, 1.0}, {1, 1, 1}, NeoHookean{.young_modulus = 1e4, .poisson_ratio = 0.45});
    strip.mesh = lattice({25, 2, 3}, [&](const Vector& s) {
      const double along = way * s[0], out = t * (s[1] - 0.5), y = 0.3 * s[2];
      if (along < L) return Vector{along, y, -R - out};
      if (along > L + bend) return Vector{way - along, y, R + out};
      const double angle = (along - L) / R;
      return Vector{L + (R + out) * std::sin(angle), y, -(R + out) * std::cos(angle)};
    });
    const auto on_boundary = boundary_nodes(strip.mesh);
    std::vector<int> skin;
    for (std::size_t n = 0; n < on_boundary.size(); ++n) if (on_boundary[n]) skin.push_back(static_cast<int>(n));
    const double high = R + 0.5 * t;
    strip.sets = {{"skin", skin}, {"foot", plane(strip.mesh.points, 2, -high)}, {"top", plane(strip.mesh.points, 2, high)}};
    Case& d = strip.description;
    d.quasi_static = false;
    d.displacements = {{"foot", {}}, {"top", {0.05, 0.02, -0.16}}};
    if (penalty > 0.0) d.forces.of<Contact>() = {{.label = "self", .set = "skin", .friction = friction, .penalty = penalty}};
    d.dynamics.duration = 1.0;
    d.dynamics.check_interval = 5;
    const Scene scene = strip.scene();
    Recorder recorder;
    try {
    const Motion motion = integrate(Model(scene, {"tl-perturbation"}), recorder);
    double depth = 0.0, cross = 1.0;
    for (const HistoryRow& row : recorder.rows) depth = std::max(depth, row.depth);
    for (std::size_t n = 0; n < motion.u.size(); ++n) {
      const Vector& X = strip.mesh.points[n];
      if (std::abs(X[2] - 0.05) > 1e-9 || X[0] > L) continue;
      const Vector up = sum(X, 1.0, motion.u[n]);
      double nearest = 1e9, z = 0;
      for (std::size_t m = 0; m < motion.u.size(); ++m) {
        if (std::abs(strip.mesh.points[m][2] + 0.05) > 1e-9) continue;
        const Vector lo = sum(strip.mesh.points[m], 1.0, motion.u[m]);
        const double r = std::hypot(up[0] - lo[0], up[1] - lo[1]);
        if (r < nearest) nearest = r, z = lo[2];
      }
      cross = std::min(cross, up[2] - z);
    }
    const HistoryRow& last = recorder.rows.back();
    fmt::print("penalty {} friction {}: steps {} seconds {} depth {} gap at end {} energy {} work {} contact {} friction {} repeated {} edge {}\n", penalty, friction, motion.steps, motion.seconds, depth, cross,
      total_energy(last), last.external_work, last.contact, last.friction, motion.repeated, shortest_edge(scene.mesh));
    } catch (const std::exception& error) { fmt::print("{}\n", error.what()); }
  }
}

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
