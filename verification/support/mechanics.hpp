#pragma once

#include "solve/stable_step.hpp"
#include "support/agreement.hpp"

/// Relations between answers that follow from mechanics.
namespace sandglass::verification {

/// A motion with reversed velocities returns to its start, step by step.
inline Verdict time_reversal(const Problem& given, const Answer& /*own*/, RandomGeometry& /*random*/) {
  Problem problem = given;
  Case& d = problem.description;
  if (problem.is_static() || d.dynamics.time_step == 0.0 || !is_conservative(problem)) return {};
  d.rotations.clear();
  for (auto& imposed : d.displacements) imposed.value = {};
  for_each_curve(d, [](LoadCurve& curve) { curve = {.times = {0.0}, .factors = {1.0}}; });
  d.dynamics.check_interval = 1;
  KeepingRecorder there, back;
  const Scene scene = problem.scene();
  if (!run(scene, problem.choice, there).failure.empty()) return {};
  const std::size_t half = there.kept().size() / 2;
  Checkpoint turned = there.kept()[half].point;
  turned.arrays["increment"] = there.kept()[half + 1].point.arrays.at("increment");
  for (double& increment : turned.arrays["increment"]) increment = -increment;
  d.dynamics.duration = d.dynamics.time_step * static_cast<double>(2 * half);
  const Scene returning = problem.scene();
  const Answer start = run(returning, problem.choice, back, &turned);
  double largest = 0.0;
  for (const Frame& frame : there.run().frames) largest = std::max(largest, largest_in(frame.u));
  if (largest == 0.0) return {};
  const double difference = start.failure.empty() ? largest_in(start.u) / largest : 1.0;
  return held_if(difference <= allowed_for_rounding(problem), difference, start.words);
}

/// The work of all loads equals the change of energy: to a percent of the largest energy or, since errors are
/// of second order, at least twice as closely with half the step.
inline Verdict energy_balance(const Problem& problem, const Answer& own, RandomGeometry& /*random*/) {
  const double step = problem.description.dynamics.time_step;
  if (problem.is_static() || step == 0.0 || !own.failure.empty() || !is_conservative(problem)) return {};
  const auto imbalance = [&](double time_step) {
    Problem again = problem;
    again.description.dynamics.time_step = time_step;
    std::vector<HistoryRow> rows;
    const Answer answer = answer_of(again, nullptr, &rows);
    double largest = 0.0;
    for (const HistoryRow& row : rows) {
      const double gained = total_energy(row) - total_energy(rows.front());
      largest = std::max(largest, std::abs(gained - row.external_work) / answer.busiest);
    }
    return largest;
  };
  const double first = imbalance(step);
  if (first <= 0.01) return held_if(true, first);
  const double second = imbalance(0.5 * step);
  return held_if(second <= 0.5 * first, first, fmt::format("{:.3g} with half the step", second));
}

/// Each of two small loads does the same work on the displacements of the other (Betti). Strains are about
/// 1e-6, and the error their square; searches to 1e-10 leave a million times that where a load acts on a
/// stiff part.
inline Verdict reciprocity(const Problem& given, const Answer& /*own*/, RandomGeometry& random) {
  Problem problem = given;
  Case& d = problem.description;
  if (!problem.is_static() || is_loose(problem) || !is_conservative(problem)) return {};
  if (slackens_somewhere(problem)) return {};  // no constant stiffness
  d.rotations.clear();
  d.forces.of<Pressure>().clear();
  d.forces.of<Gravity>().clear();
  d.displacements = {{"held", {}}};
  d.relaxation.tolerance = 1e-10;
  const double force = 1e-9 * 3000.0 * std::pow(diagonal(problem.mesh.points), 2);
  const auto loaded = [&](const char* set) {
    d.forces.of<DeadForce>() = {{.set = set, .on = DeadForce::Carrier::nodes}};
    for (double& f : d.forces.of<DeadForce>().front().total) f = force * random.uniform(-1.0, 1.0);
    return std::pair{dead_loads(problem.scene().forces), answer_of(problem)};
  };
  const auto [f, u] = loaded("side");
  const auto [g, w] = loaded("moved");
  if (!u.failure.empty() || !w.failure.empty()) return {};
  const auto work = [](const std::vector<NodalLoad>& dead, const NodalField& way) {
    double sum = 0.0;
    for (const auto& load : dead) {
      for (std::size_t i = 0; i < 3; ++i) sum += load.force[i] * way[at(load.node)][i];
    }
    return sum;
  };
  const double unit = std::sqrt(std::abs(work(f, u.u) * work(g, w.u)));
  if (unit == 0.0) return {};  // a load acts on held nodes
  const double difference = std::abs(work(f, w.u) - work(g, u.u)) / unit;
  return held_if(difference <= 1e-4, difference);
}

/// Linear methods: the answer to all loads is the sum of the answer to forces and imposed displacements and
/// of the answer to the other loads.
inline Verdict superposition(const Problem& problem, const Answer& own, RandomGeometry& /*random*/) {
  const Case& d = problem.description;
  if (!problem.method().is_linear || !d.rotations.empty() || !d.forces.of<Pressure>().empty()) return {};
  Problem first = problem, second = problem;
  first.description.forces.of<Gravity>().clear();
  first.description.velocities.clear();
  second.description.forces.of<DeadForce>().clear();
  for (auto& imposed : second.description.displacements) imposed.value = {};
  Answer sum = answer_of(first);
  const Answer other = answer_of(second);
  if (!own.failure.empty() || !sum.failure.empty() || !other.failure.empty()) return {};
  for (std::size_t n = 0; n < sum.u.size(); ++n) {
    for (std::size_t i = 0; i < 3; ++i) sum.u[n][i] += other.u[n][i];
  }
  const double unit = std::max({own.largest, sum.largest, other.largest});
  const double difference = unit > 0.0 ? largest_distance(sum.u, own.u) / unit : 0.0;
  return held_if(difference <= allowed_for_rounding(problem), difference);
}

/// A motion under the same loads, damped until it stops, ends at the static answer, or close enough for a
/// search from there to stay.
inline Verdict damping(const Problem& given, const Answer& own, RandomGeometry& /*random*/) {
  constexpr long most_steps = 10000;
  if (!given.is_static() || given.method().is_condensed || is_loose(given) || !own.failure.empty()) return {};
  if (!is_conservative(given)) return {};
  Problem problem = given;
  const Scene scene = problem.scene();
  const Model model(scene, problem.choice);
  double inertia = 0.0;
  for (std::size_t n = 0; n < own.u.size(); ++n) inertia += model.masses()[n] * std::pow(length(own.u[n]), 2);
  const double rate = std::sqrt(2.0 * std::abs(own.energy) / inertia);  // rad/s, Rayleigh quotient
  Case& d = problem.description;
  d.quasi_static = false;
  d.dynamics = {.duration = 40.0 / rate, .ramp_time = 10.0 / rate, .damping = 1.5 * rate, .frames = 1};
  for_each_curve(d, [&](LoadCurve& curve) { multiply(curve.times, d.dynamics.ramp_time); });
  const double step = 0.5 * stable_step(model, NodalField(own.u.size())).step;
  if (!(d.dynamics.duration < most_steps * step)) return {};
  problem.steps = most_steps / 10;
  const Answer moved = answer_of(problem);
  if (!moved.failure.empty()) return {Kind::explained, 1.0, moved.words};
  const double difference = largest_distance(moved.u, own.u) / own.largest;
  if (difference <= 1e-3) return held_if(true, difference);
  const Answer near = answer_of(given, &moved.u);
  const bool led = near.failure.empty() && largest_distance(near.u, own.u) <= 1e-4 * own.largest;
  if (led) return {Kind::explained, difference, "it still moved"};
  // Of several equilibria a search may find an unstable one if it does not check stability.
  return {own.stable ? Kind::violated : Kind::explained, difference, "another rest"};
}

}  // namespace sandglass::verification
