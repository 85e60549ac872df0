#include "benchmark/side_by_side.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <nlohmann/json.hpp>

#include "base/error.hpp"
#include "sandglass/batch.hpp"

namespace sandglass {

namespace {

using Clock = std::chrono::steady_clock;

constexpr int steps_per_frame = 20;

/// The largest difference between the displacements of both computations over the largest displacement.
template <class Real>
double difference(const std::vector<Simulation<Real>>& simulations, const Batch<Real>& batch) {
  double apart = 0.0, largest = 0.0;
  for (std::size_t b = 0; b < simulations.size(); ++b) {
    const NodalView<Real> u = simulations[b].displacements();
    const auto rows = simulations[b].row_of_node();
    for (std::size_t n = 0; n < rows.size(); ++n) {
      const auto other = batch.displacement(b, n);
      for (std::size_t i = 0; i < 3; ++i) {
        const double one = u[static_cast<std::size_t>(rows[n])][i];
        apart = std::max(apart, std::abs(one - other[i]));
        largest = std::max(largest, std::abs(one));
      }
    }
  }
  return apart / largest;
}

template <class Real>
SideBySide time_bodies(const Case& description, const MethodChoice& choice, std::size_t bodies,
                       int repetitions, const Proceed& proceed) {
  const SimulationSettings settings{
      .method = choice.method, .kappa = choice.kappa, .step_fraction = 0.8, .threads = choice.threads};
  const Simulation<Real> first(description.file, settings);
  std::vector<Simulation<Real>> simulations(bodies, first);
  Batch<Real> batch(description.file, bodies, settings);
  for (std::size_t b = 0; b < bodies; ++b) {
    const double factor = 1e-3 * (1.0 + static_cast<double>(b) / static_cast<double>(bodies));
    simulations[b].impose(factor);
    batch.impose(b, factor);
  }
  SideBySide result{description.name, first.cells().size(), bodies, choice, "ok", {}, {}, 0.0};
  const double frame = steps_per_frame * 0.99 * batch.step_size();  // all take as many steps
  const double work = static_cast<double>(bodies * result.elements) * steps_per_frame;
  const auto ns_of = [&](const auto& advance) {
    const auto start = Clock::now();
    advance();
    return std::chrono::duration<double, std::nano>(Clock::now() - start).count() / work;
  };
  std::vector<double> one_by_one, together;
  for (int r = 0; r < repetitions; ++r) {
    if (!proceed(static_cast<double>(r) / repetitions)) throw ComputationError("bench: interrupted");
    one_by_one.push_back(ns_of([&] {
      for (auto& simulation : simulations) simulation.advance(frame);
    }));
    together.push_back(ns_of([&] { batch.advance(frame); }));
  }
  result.one_by_one = spread_of(one_by_one);
  result.batch = spread_of(together);
  result.ratio = result.batch.median / result.one_by_one.median;
  // Sums in another order, whose rounding accumulates over all steps.
  const double steps = static_cast<double>(repetitions) * steps_per_frame;
  const double limit = 100.0 * steps * static_cast<double>(std::numeric_limits<Real>::epsilon());
  if (const double apart = difference(simulations, batch); !(apart < limit)) {
    result.status = fmt::format("wrong result: displacements differ by {:.1e}, allowed {:.1e}", apart, limit);
  }
  return result;
}

}  // namespace

SideBySide time_side_by_side(const Case& description, const MethodChoice& choice, std::size_t bodies,
                             int repetitions, const Proceed& proceed) {
  return choice.precision == Precision::double_precision
             ? time_bodies<double>(description, choice, bodies, repetitions, proceed)
             : time_bodies<float>(description, choice, bodies, repetitions, proceed);
}

std::string to_json(const Provenance& provenance, const std::vector<SideBySide>& records) {
  nlohmann::ordered_json document;
  for (const auto& [name, value] : provenance) document[name] = value;
  document["records"] = nlohmann::ordered_json::array();
  for (const auto& record : records) {
    document["records"].push_back({{"case", record.case_name},
                                   {"elements", record.elements},
                                   {"bodies", record.bodies},
                                   {"method", record.choice.method},
                                   {"precision", name_of(record.choice.precision)},
                                   {"threads", record.choice.threads},
                                   {"status", record.status},
                                   {"one_by_one_ns_per_element_step", record.one_by_one.median},
                                   {"batch_ns_per_element_step", record.batch.median},
                                   {"ratio", record.ratio}});
  }
  return document.dump(1) + "\n";
}

}  // namespace sandglass
