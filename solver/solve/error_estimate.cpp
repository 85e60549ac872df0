#include "solve/error_estimate.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdlib>
#include <numeric>

#include "base/error.hpp"
#include "mesh/hexahedron.hpp"
#include "problem/scene_refinement.hpp"
#include "solve/equilibrium.hpp"
#include "solve/relaxation.hpp"

namespace sandglass {

namespace {

/// An answer of the mean-dilatation element and the evaluations of its forces.
struct BetterAnswer {
  NodalField u;
  long evaluations;
};

/// The equilibrium of the mean-dilatation element near u (m), to a hundredth of the residual there.
BetterAnswer better_answer(const Scene& scene, const NodalField& u, int threads) {
  constexpr double share_left = 0.01;
  const Model exact(scene, {.method = std::string(estimate_method), .threads = threads});
  const auto& elements = *std::get<std::unique_ptr<InternalForce<double>>>(exact.internal_force());
  Equilibrium<double> search(exact, elements);
  search.body().state() = state_at(elements, u);
  search.body().impose(1.0);
  if (!search.body().healthy()) {
    throw ComputationError("the mean-dilatation element is inverted at this answer: no estimate");
  }
  search.take_own_pressures();
  search.start(Effort::full);
  const double enough = std::max(share_left * search.residual(), scene.description.relaxation.tolerance);
  while (search.residual() > enough) {
    if (!search.step()) {
      throw ComputationError(
          "the mean-dilatation element's forces are not finite near this answer: no estimate");
    }
  }
  return {search.body().field(search.body().state().u), search.evaluations()};
}

double rms_distance(const NodalField& a, const NodalField& b) {
  double squares = 0.0;
  for (std::size_t n = 0; n < a.size(); ++n) squares += std::pow(distance(a[n], b[n]), 2);
  return std::sqrt(squares / static_cast<double>(a.size()));
}

}  // namespace

ErrorEstimate estimate_error(const Model& model, const NodalField& u) {
  const auto [better, evaluations] = better_answer(model.scene(), u, model.choice().threads);
  return {.largest = largest_distance(better, u), .rms = rms_distance(better, u), .evaluations = evaluations};
}

std::vector<double> error_indicators(const Scene& scene, const NodalField& u) {
  const Mesh& mesh = scene.mesh;
  std::vector<Tensor<double>> gradients;
  std::vector<double> volumes;
  for (const auto& cell : mesh.cells) {
    const auto [h, volume] = mean_gradient(gather(mesh.points, cell));
    gradients.push_back(transpose(gather(u, cell)) * h);
    volumes.push_back(volume);
  }
  std::vector<double> indicators(mesh.cells.size(), 0.0);
  for (std::size_t m = 0; m < scene.materials.list.size(); ++m) {
    std::vector<double> weights(mesh.points.size(), 0.0);
    std::array<std::vector<double>, 9> sums;
    sums.fill(weights);
    for (std::size_t e = 0; e < mesh.cells.size(); ++e) {
      if (scene.materials.of(e) != m) continue;
      for (const int node : mesh.cells[e]) {
        const auto n = static_cast<std::size_t>(node);
        weights[n] += volumes[e];
        for (std::size_t k = 0; k < 9; ++k) sums[k][n] += volumes[e] * gradients[e](static_cast<int>(k / 3), static_cast<int>(k % 3));
      }
    }
    weights = handed_on(scene.ties, std::move(weights));
    NodalField rows[3] = {NodalField(mesh.points.size()), NodalField(mesh.points.size()), NodalField(mesh.points.size())};
    for (std::size_t k = 0; k < 9; ++k) {
      const auto sum = handed_on(scene.ties, sums[k]);
      for (std::size_t n = 0; n < sum.size(); ++n)
        rows[k / 3][n][k % 3] = weights[n] > 0.0 ? sum[n] / weights[n] : 0.0;
    }
    for (auto& row : rows) follow(scene.ties, row);
    for (std::size_t e = 0; e < mesh.cells.size(); ++e) {
      if (scene.materials.of(e) != m) continue;
      double squares = 0.0;
      for (const int node : mesh.cells[e]) {
        const auto n = static_cast<std::size_t>(node);
        for (int i = 0; i < 3; ++i)
          for (int j = 0; j < 3; ++j)
            squares += std::pow(rows[i][n][static_cast<std::size_t>(j)] - gradients[e](i, j), 2);
      }
      indicators[e] = volumes[e] * squares / 8.0;
    }
  }
  return indicators;
}

std::vector<int> largest_share(const std::vector<double>& indicators, double share) {
  std::vector<int> order(indicators.size());
  std::iota(order.begin(), order.end(), 0);
  const auto of = [&](int e) { return indicators[static_cast<std::size_t>(e)]; };
  std::stable_sort(order.begin(), order.end(), [&](int a, int b) { return of(a) > of(b); });
  double left = share * std::accumulate(indicators.begin(), indicators.end(), 0.0);
  std::size_t count = 0;
  while (count < order.size() && left > 0.0) left -= of(order[count++]);
  order.resize(count);
  std::sort(order.begin(), order.end());
  return order;
}

TruthEstimate estimate_truth_error(const Model& model, const NodalField& u) {
  const double share = getenv("SHARE") ? atof(getenv("SHARE")) : 0.5;
  const double phi = getenv("PHI") ? atof(getenv("PHI")) : 0.5;
  const int rounds = getenv("ROUNDS") ? atoi(getenv("ROUNDS")) : 1;
  const int threads = model.choice().threads;
  auto [coarse, evaluations] = better_answer(model.scene(), u, threads);
  const std::size_t nodes = u.size();
  Scene scene = model.scene();
  NodalField before, at = coarse;
  for (int round = 0; round < rounds; ++round) {
    scene = refined(scene, largest_share(error_indicators(scene, at), share));
    const auto start = std::chrono::steady_clock::now();
    long count = 0;
    NodalField next;
    try {
      auto found = better_answer(scene, prolonged(scene.coarser.front(), at), threads);
      next = std::move(found.u); count = found.evaluations;
    } catch (const ComputationError& error) {
      fmt::print("from rest: {}\n", error.what());
      Observer quiet;
      Model exact(scene, {.method = std::string(estimate_method), .threads = threads});
      auto found = relax(exact, quiet);
      next = std::move(found.u); count = found.steps;
    }
    const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    fmt::print("round {}: {} elements, {} evaluations, {:.3g} s\n", round, scene.mesh.cells.size(), count, seconds);
    before = std::move(at);
    at = std::move(next);
    evaluations += count;
    NodalField limit(nodes);
    for (double phi2 : {0.0, .3, .5, .7, 1.0}) {
      for (std::size_t n = 0; n < nodes; ++n)
        for (std::size_t i = 0; i < 3; ++i) limit[n][i] = at[n][i] + phi2 * (at[n][i] - before[n][i]);
      const double unit = displacement_unit(scene, u);
      fmt::print("  phi {:.2g}: max {:.4g} % rms {:.4g} %\n", phi2, 100 * largest_distance(limit, u) / unit, 100 * rms_distance(limit, u) / unit);
    }
  }
  NodalField limit(nodes);
  for (std::size_t n = 0; n < nodes; ++n)
    for (std::size_t i = 0; i < 3; ++i) limit[n][i] = at[n][i] + phi * (at[n][i] - before[n][i]);
  return {.largest = largest_distance(limit, u),
          .rms = rms_distance(limit, u),
          .elements = scene.mesh.cells.size(),
          .evaluations = evaluations};
}

}  // namespace sandglass
