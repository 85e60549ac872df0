#include "comparison/truth_estimate.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <numeric>
#include <utility>

#include "base/error.hpp"
#include "mesh/hexahedron.hpp"
#include "problem/scene_refinement.hpp"
#include "solve/error_estimate.hpp"
#include "solve/relaxation.hpp"

namespace sandglass {

namespace {

/// Each refinement splits elements with this share of the sum of all indicators. A larger share wastes
/// elements, a smaller one needs more searches.
constexpr double refined_share = 0.6;

/// The change from the last answer to the limit, as a share of the change before: 1 / (2^p - 1) for p = 1.3,
/// which lies between the orders of singular edges (about 1) and of smooth answers (2).
constexpr double left_of_change = 0.7;

/// The residual at which searches end, over the requested accuracy. The relative distance of displacements
/// from equilibrium is about as large as the residual.
constexpr double tolerance_over_accuracy = 0.1;

/// The accuracy of answers for an estimate, below the errors that are estimated.
constexpr double accuracy_of_estimate = 1e-3;

/// Evaluations after which a search that starts near an answer is given up: a successful one takes ten or
/// twenty, or a hundred from the undeformed state.
constexpr int most_evaluations_near = 500;

/// Volume-weighted means of the elements' displacement gradients at the nodes of one material.
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

  /// Divides by the weights, after tied nodes have passed theirs to the nodes that they follow.
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

/// The mean-dilatation element's answer (m); if u (m) is given, a short search near it.
NodalField find_answer(Scene scene, const NodalField* u, int threads) {
  int& most = scene.settings.relaxation.max_steps;
  if (u != nullptr) most = std::min(most, most_evaluations_near);
  const Model model(scene, {.method = std::string(estimate_method), .threads = threads});
  Observer quiet;
  Relaxation found = relax(model, quiet, nullptr, u);
  if (!found.converged) throw ComputationError(outcome(found, Precision::double_precision));
  return std::move(found.u);
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
    indicators.push_back(share_of_node(volumes[e]) * squares);
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

RefinedAnswer::RefinedAnswer(CaseOnMesh problem, double accuracy, int threads, const NodalField* near)
    : threads_(threads), problem_(std::move(problem)) {
  RelaxationSettings& settings = problem_.description.relaxation;
  settings.tolerance = std::max(settings.tolerance, tolerance_over_accuracy * accuracy);
  settings.check_interval = 1;
  scene_ = make_scene(problem_);
  original_nodes_ = scene_.mesh.points.size();
  u_ = before_ = find_answer(scene_, near, threads);
}

void RefinedAnswer::refine() {
  CaseOnMesh problem = problem_;
  problem.description =
      refined(problem.description, largest_share(error_indicators(scene_, u_), refined_share));
  Scene finer = make_scene(problem);
  const NodalField guess = prolonged(finer.coarser.front(), u_);
  try {
    before_ = std::exchange(u_, find_answer(finer, &guess, threads_));
  } catch (const ComputationError& error) {
    throw ComputationError(fmt::format("no answer found on the refined mesh of {} elements: {}",
                                       finer.mesh.cells.size(), error.what()),
                           error.breakdown());
  }
  problem_ = std::move(problem);
  scene_ = std::move(finer);
}

NodalField RefinedAnswer::limit() const {
  NodalField limit(original_nodes_);
  for (std::size_t n = 0; n < original_nodes_; ++n)
    for (std::size_t i = 0; i < 3; ++i) limit[n][i] = u_[n][i] + left_of_change * (u_[n][i] - before_[n][i]);
  return limit;
}

AccurateMesh refine_until_within(double accuracy, const CaseOnMesh& problem, int threads,
                                 std::size_t most_elements) {
  const auto start = std::chrono::steady_clock::now();
  RefinedAnswer answer(problem, accuracy, threads);
  const double unit = displacement_unit(answer.scene(), answer.u());
  std::string nearest = "the error of its answer is unknown";
  const auto fail = [&](const std::string& why) {
    return ComputationError(fmt::format("{}: the mesh of {} elements is not refined further, and {}: {}",
                                        problem.description.name, answer.scene().mesh.cells.size(), nearest,
                                        why));
  };
  while (true) {
    if (answer.scene().mesh.cells.size() > most_elements)
      throw fail(fmt::format("it has more than {} elements", most_elements));
    AccurateMesh before{answer.problem(), answer.scene(), answer.u(), {}, 0.0};
    try {
      answer.refine();
    } catch (const ComputationError& error) {
      throw fail(error.what());
    }
    const NodalField limit = answer.limit();
    const auto error = [&](const NodalField& u) { return largest_distance(limit, u) / unit; };
    const auto took = [&] {
      return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    };
    if (error(before.u) <= accuracy) {
      before.limit = limit;
      before.seconds = took();
      return before;
    }
    if (error(answer.u()) <= accuracy) return {answer.problem(), answer.scene(), answer.u(), limit, took()};
    nearest = fmt::format("the estimated error of its answer is {:.3g} %, not {:.3g} %",
                          100.0 * error(answer.u()), 100.0 * accuracy);
  }
}

TruthEstimate estimate_truth_error(const CaseOnMesh& problem, int threads, const NodalField& u) {
  constexpr int times = 2;
  RefinedAnswer refined(problem, accuracy_of_estimate, threads, &u);
  TruthEstimate estimate;
  for (int n = 0; n < times; ++n) {
    try {
      refined.refine();
    } catch (const ComputationError& error) {
      if (n == 0) throw;
      estimate.remark = error.what();
      break;
    }
  }
  const NodalField limit = refined.limit();
  estimate.largest = largest_distance(limit, u);
  estimate.rms = rms_distance(limit, u);
  estimate.elements = refined.scene().mesh.cells.size();
  return estimate;
}

}  // namespace sandglass
