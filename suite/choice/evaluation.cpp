#include "choice/evaluation.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <limits>

#include "assembly/method_entry.hpp"
#include "base/error.hpp"
#include "comparison/accuracy.hpp"
#include "comparison/answer.hpp"
#include "comparison/comparison.hpp"
#include "mesh/hexahedron.hpp"
#include "mesh/interpolation.hpp"

namespace sandglass {

namespace {

/// The load, over the case's, at which a candidate must still find an answer.
constexpr double margin = 1.1;

/// Asks whether to continue during the search for an answer.
class Asking final : public Observer {
 public:
  explicit Asking(const Proceed& proceed) : proceed_(proceed) {}
  bool proceed(long /*step*/, double share, double /*residual*/) override {
    stopped_ = stopped_ || !proceed_(share);
    return !stopped_;
  }
  bool stopped() const { return stopped_; }

 private:
  const Proceed& proceed_;
  bool stopped_ = false;
};

Answer find_answer(const Scene& scene, const MethodChoice& choice, const Proceed& proceed) {
  Asking observer(proceed);
  Answer answer = compute_answer(scene, choice, observer);
  if (observer.stopped()) throw ComputationError("choose: interrupted; nothing was written");
  return answer;
}

MethodChoice golden_element(int threads) {
  return {.method = std::string(golden_method), .threads = threads};
}

double smallest_jacobian(const Model& model, const Displacements& history) {
  double smallest = std::numeric_limits<double>::infinity();
  std::vector<double> jacobians(model.scene().mesh.cells.size());
  for (const NodalField& u : history) {
    std::visit([&](const auto& elements) { elements->smallest_jacobians(state_at(*elements, u), jacobians); },
               model.internal_force());
    smallest = std::min(smallest, *std::min_element(jacobians.begin(), jacobians.end()));
  }
  return smallest;
}

/// The largest norm of the elements' mean displacement gradients: strain and rotation together.
double largest_gradient(const Mesh& mesh, const Displacements& history) {
  double largest = 0.0;
  for (const auto& cell : mesh.cells) {
    const auto h = mean_gradient(gather(mesh.points, cell)).h;
    for (const NodalField& u : history) {
      const Tensor<double> H = transpose(gather(u, cell)) * h;
      largest = std::max(largest, std::sqrt(double_dot(H, H)));
    }
  }
  return largest;
}

/// The mistake of an answer that is too far from the reference.
std::string error_reason(const Candidate& candidate, const Symptoms& symptoms, double tolerance,
                         double gradient) {
  if (method_named(candidate.choice.method).is_linear && gradient > 0.1) {
    return fmt::format("small-strain theory, but displacement gradients reach {:.2g}", gradient);
  }
  switch (diagnose(symptoms, tolerance)) {
    case Finding::hourglassing:
      return fmt::format("nodes zigzag: {:.2g} times the reference's hourglass amplitudes",
                         symptoms.bending_ratio);
    case Finding::locking:
      return fmt::format("locks: takes {:.2g} % more energy to deform",
                         100.0 * (symptoms.stiffness_ratio - 1.0));
    default:
      return fmt::format("inaccurate; {:.2g} % of the squared error is in hourglass modes",
                         100.0 * symptoms.zigzag_share);
  }
}

/// How a computation failed, in mechanical terms.
std::string failure_reason(const Answer& answer) {
  if (answer.failure == Finding::inverted) return "an element turns inside out";
  if (answer.failure == Finding::unstable) return "displacements grow without limit";
  return answer.status;
}

/// The error of a reference that is not the truth: measured if the truth of the case is stored, else
/// estimated when its golden was made.
OwnError own_error_of(const Reference& reference, const Comparison& comparison, const Scene& scene) {
  try {
    const Displacements truth = read_reference(comparison.truth, scene);
    return {accuracy(reference.u, truth, nullptr, reference.unit).max_relative_error,
            "measured against the stored truth"};
  } catch (const InputError&) {  // there is no truth, or it belongs to another case
  }
  try {
    read_reference(comparison.golden, scene);
    return read_own_error(comparison.golden);
  } catch (const InputError&) {
    return {{}, "there is neither a stored truth nor a golden"};
  }
}

}  // namespace

Reference make_reference(const Scene& scene, const std::string& against, const Proceed& proceed) {
  const Comparison comparison = read_comparison(scene);
  Reference reference{.name = against, .u = {}, .unit = 0.0, .own = {}};
  if (!against.empty()) {
    const auto& path = against == "truth" ? comparison.truth : comparison.golden;
    if (std::error_code ignored; !std::filesystem::exists(path, ignored)) {
      throw InputError(
          fmt::format("{}: the case has no {}, as there is no {}; without --against, errors are those "
                      "to the answer of {} on this mesh",
                      scene.settings.name, against, path.string(), golden_method));
    }
    reference.u = read_reference(path, scene);
  } else {
    reference.name = golden_method;
    Answer answer = find_answer(scene, golden_element(1), proceed);
    if (answer.refused || answer.failure) {
      throw ComputationError(
          fmt::format("{}: the reference, {}, finds no answer: {}; remedy: impose less, refine the mesh, or "
                      "name a stored one with --against",
                      scene.settings.name, reference.name, answer.status));
    }
    reference.u = std::move(answer.u);
  }
  reference.unit = displacement_unit(scene, reference.u);
  reference.own =
      against == "truth" ? read_own_error(comparison.truth) : own_error_of(reference, comparison, scene);
  return reference;
}

Evaluator::Evaluator(const Scene& scene, const Reference& reference, double tolerance, const Proceed& proceed)
    : scene_(scene),
      reference_(reference),
      tolerance_(tolerance),
      proceed_(proceed),
      largest_gradient_(largest_gradient(scene.mesh, reference.u)) {}

Evaluation Evaluator::evaluate(const Candidate& candidate) {
  Evaluation found = evaluate_answer(candidate);
  if (found.reason.empty()) found.reason = margin_reason(candidate);
  return found;
}

Evaluation Evaluator::evaluate_mesh(const CandidateMesh& mesh) {
  Evaluation found = evaluate_answer({golden_element(1), &mesh});
  if (!found.reason.empty() && found.error) {
    found.reason = mesh.steps.empty() ? "too coarse for any method" : "too soft for any method";
  }
  return found;
}

Evaluation Evaluator::evaluate_answer(const Candidate& candidate) {
  const Scene& scene = candidate.mesh->scene;
  const Answer answer = find_answer(scene, candidate.choice, proceed_);
  if (answer.refused || answer.u.empty()) return {.reason = failure_reason(answer)};
  Evaluation found;
  found.smallest_jacobian = smallest_jacobian(Model(scene, candidate.choice), answer.u);
  if (!scene.settings.quasi_static)
    found.per_simulated_second = answer.seconds / scene.settings.dynamics.duration;
  const Displacements u =
      candidate.mesh->own() ? answer.u : interpolate(scene.mesh, answer.u, scene_.mesh.points);
  found.error = accuracy(u, reference_.u, nullptr, reference_.unit).max_relative_error;
  if (answer.failure) {
    found.reason = failure_reason(answer);
  } else if (!(*found.error <= tolerance_)) {
    // Nodes of a coarser mesh are compared with the reference's displacements on that mesh.
    const Symptoms observed = symptoms(scene, answer.u, answer.energies.strain + answer.energies.hourglass,
                                       candidate.mesh->reference, reference_.unit);
    found.reason = error_reason(
        candidate, {*found.error, observed.zigzag_share, observed.bending_ratio, observed.stiffness_ratio},
        tolerance_, largest_gradient_);
  }
  return found;
}

std::string Evaluator::margin_reason(const Candidate& candidate) {
  const auto survives = [&](const MethodChoice& choice) {
    const Scene harder = scaled(candidate.mesh->scene, margin);
    return find_answer(harder, choice, proceed_);
  };
  const Answer beyond = survives(candidate.choice);
  if (!beyond.failure && !beyond.refused) return "";
  const Answer golden = survives(golden_element(candidate.choice.threads));
  if (golden.failure || golden.refused) return "";
  return fmt::format("no reserve: with a tenth more load {}", failure_reason(beyond));
}

Displacements interpolate(const Mesh& mesh, const Displacements& history, const NodalField& points) {
  Displacements there;
  for (const NodalField& u : history) there.push_back(interpolate(mesh, u, points));
  return there;
}

CaseOnMesh on_mesh(const AnyGenerator& mesh, Case description) {
  CaseOnMesh problem{std::move(description), generate_mesh(mesh)};
  problem.description.mesh = mesh;
  const auto on_boundary = boundary_nodes(problem.mesh);
  std::erase_if(problem.description.sets, [&](const NodeSetRule& rule) {
    if (!select_nodes(problem.mesh, on_boundary, rule).empty()) return false;
    problem.sets[rule.name] = {};  // for the message, if a table names it
    return true;
  });
  return problem;
}

}  // namespace sandglass
