#include "solve/truth_estimate.hpp"

#include <algorithm>
#include <chrono>
#include <limits>
#include <numeric>

#include "base/error.hpp"
#include "mesh/hexahedron.hpp"
#include "problem/scene_refinement.hpp"
#include "solve/error_estimate.hpp"
#include "solve/relaxation.hpp"

namespace sandglass {

namespace {

/// The share of the indicators that is refined at once. Larger ones waste elements, smaller ones searches.
constexpr double refined_share = 0.6;

/// What is left of the last change of an answer: of order 1.3, as where edges dominate, were the mesh refined
/// everywhere.
constexpr double left_of_change = 0.7;

std::size_t at(int n) {
  return static_cast<std::size_t>(n);
}

/// Means of the elements' displacement gradients, weighted by volume, at the nodes of one material.
class RecoveredGradients {
 public:
  explicit RecoveredGradients(std::size_t nodes) : sums_(nodes), weights_(nodes, 0.0) {}

  void add(const Hexahedron& cell, const Tensor<double>& H, double volume) {
    for (const int node : cell) {
      for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j) sums_[at(node)](i, j) += volume * H(i, j);
      weights_[at(node)] += volume;
    }
  }

  /// Tied nodes hand on what they have, and follow.
  void finish(const Ties& ties) {
    for (const auto& [node, mean_of] : ties) {
      for (const auto& [free, weight] : mean_of) {
        add_to(at(free), weight, at(node));
        weights_[at(free)] += weight * weights_[at(node)];
      }
    }
    for (std::size_t n = 0; n < sums_.size(); ++n) {
      if (weights_[n] > 0.0) sums_[n] = (1.0 / weights_[n]) * sums_[n];
    }
    for (const auto& [node, mean_of] : ties) {
      sums_[at(node)] = {};
      for (const auto& [free, weight] : mean_of) add_to(at(node), weight, at(free));
    }
  }

  const Tensor<double>& at_node(int node) const { return sums_[at(node)]; }

 private:
  void add_to(std::size_t to, double weight, std::size_t from) {
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j) sums_[to](i, j) += weight * sums_[from](i, j);
  }

  std::vector<Tensor<double>> sums_;
  std::vector<double> weights_;
};

/// The mean-dilatation element's answer, near u (m) if that is given.
Relaxation find_answer(const Scene& scene, const NodalField* near, int threads) {
  const Model model(scene, {.method = std::string(estimate_method), .threads = threads});
  Observer quiet;
  Relaxation found = relax(model, quiet, nullptr, near);
  if (!found.converged) throw ComputationError(outcome(found, Precision::double_precision));
  return found;
}

}  // namespace

std::vector<double> error_indicators(const Scene& scene, const NodalField& u) {
  const Mesh& mesh = scene.mesh;
  std::vector<Tensor<double>> gradients;
  std::vector<double> volumes;
  std::vector<RecoveredGradients> recovered(scene.materials.list.size(),
                                            RecoveredGradients(mesh.points.size()));
  for (std::size_t e = 0; e < mesh.cells.size(); ++e) {
    const auto [h, volume] = mean_gradient(gather(mesh.points, mesh.cells[e]));
    gradients.push_back(transpose(gather(u, mesh.cells[e])) * h);
    volumes.push_back(volume);
    recovered[scene.materials.of(e)].add(mesh.cells[e], gradients[e], volume);
  }
  for (auto& of_material : recovered) of_material.finish(scene.ties);
  std::vector<double> indicators;
  for (std::size_t e = 0; e < mesh.cells.size(); ++e) {
    double squares = 0.0;
    for (const int node : mesh.cells[e]) {
      const Tensor<double> difference = recovered[scene.materials.of(e)].at_node(node) - gradients[e];
      squares += double_dot(difference, difference);
    }
    indicators.push_back(volumes[e] * squares / 8.0);
  }
  return indicators;
}

std::vector<int> largest_share(const std::vector<double>& indicators, double share) {
  std::vector<int> elements(indicators.size());
  std::iota(elements.begin(), elements.end(), 0);
  std::stable_sort(elements.begin(), elements.end(),
                   [&](int a, int b) { return indicators[at(a)] > indicators[at(b)]; });
  double left = share * std::accumulate(indicators.begin(), indicators.end(), 0.0);
  std::size_t count = 0;
  while (count < elements.size() && left > 0.0) left -= indicators[at(elements[count++])];
  elements.resize(count);
  std::sort(elements.begin(), elements.end());
  return elements;
}

Refining::Refining(const Scene& scene, const NodalField* near, int threads)
    : threads_(threads), nodes_(scene.mesh.points.size()) {
  Relaxation found = find_answer(scene, near, threads);
  answer_ = {scene, std::move(found.u), found.steps, found.seconds};
}

void Refining::refine() {
  const auto start = std::chrono::steady_clock::now();
  Scene finer =
      refined(answer_.scene, largest_share(error_indicators(answer_.scene, answer_.u), refined_share));
  const NodalField guess = prolonged(finer.coarser.front(), answer_.u);
  Relaxation found = find_answer(finer, &guess, threads_);
  before_ = std::move(answer_.u);
  const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  answer_ = {std::move(finer), std::move(found.u), answer_.evaluations + found.steps,
             answer_.seconds + seconds};
}

NodalField Refining::on_original(const NodalField& u) const {
  return NodalField(u.begin(), u.begin() + static_cast<std::ptrdiff_t>(nodes_));
}

NodalField Refining::limit() const {
  NodalField limit = on_original(answer_.u);
  if (before_.empty()) return limit;
  for (std::size_t n = 0; n < nodes_; ++n)
    for (std::size_t i = 0; i < 3; ++i) limit[n][i] += left_of_change * (limit[n][i] - before_[n][i]);
  return limit;
}

double Refining::error() const {
  if (before_.empty()) return std::numeric_limits<double>::infinity();
  return largest_distance(limit(), on_original(answer_.u));
}

TruthEstimate estimate_truth_error(const Model& model, const NodalField& u) {
  constexpr int times = 2;
  Refining refining(model.scene(), &u, model.choice().threads);
  TruthEstimate estimate;
  for (int n = 0; n < times; ++n) {
    try {
      refining.refine();
    } catch (const ComputationError& error) {
      if (n == 0) throw;
      estimate.remark = error.what();
      break;
    }
  }
  const NodalField limit = refining.limit();
  estimate.largest = largest_distance(limit, u);
  estimate.rms = rms_distance(limit, u);
  estimate.elements = refining.answer().scene.mesh.cells.size();
  return estimate;
}

}  // namespace sandglass
