#include "choice/choose.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "assembly/method_entry.hpp"
#include "base/error.hpp"
#include "base/names.hpp"
#include "choice/candidate_cost.hpp"
#include "choice/longer_steps.hpp"
#include "choice/variations.hpp"
#include "comparison/comparison.hpp"
#include "comparison/truth_estimate.hpp"
#include "mesh/interpolation.hpp"

namespace sandglass {

namespace {

/// Evaluations of the forces after which a candidate has no static equilibrium: existing answers take some
/// hundreds.
constexpr int most_evaluations = 2000;

void require_methods(const Demand& demand) {
  for (const auto& name : demand.methods) method_named(name, "--methods");
}

/// The meshes of candidates: the user's, and others on which the golden's own element still finds an answer.
/// All others that were tried are reported.
class Meshes {
 public:
  Meshes(CaseOnMesh problem, const Scene& scene, Choice& choice, Evaluator& evaluator)
      : scene_(scene), choice_(choice), evaluator_(evaluator) {
    int& most = problem.description.relaxation.max_steps;
    most = std::min(most, most_evaluations);
    choice_.meshes.push_back({{}, problem, make_scene(problem), choice.reference.u});
  }

  void add_coarser() {
    const auto* generator = std::get_if<AnyGenerator>(&own().mesh);
    if (generator == nullptr) return;
    for (const auto& coarser : coarser_meshes(*generator)) {
      const std::string difference = counts_text(coarser);
      try {
        const CaseOnMesh problem = on_mesh(coarser, own());
        if (!try_out_mesh(difference, problem)) too_coarse_.emplace_back(difference, problem);
      } catch (const InputError& error) {
        choice_.others.push_back({difference, {{}, {}, {}, error.what()}});
      }
    }
  }

  /// For a motion: each mesh with longer steps, as long as the golden's own element is accurate enough.
  void add_longer_steps() {
    for (std::size_t n = 0, count = choice_.meshes.size(); n < count; ++n) {
      for (const auto& [steps, problem] : longer_steps(choice_.meshes[n].problem)) {
        const CandidateMesh& mesh = choice_.meshes[n];
        if (!try_out({mesh.difference, problem, make_scene(problem), mesh.reference, steps})) break;
      }
    }
  }

  /// Refines meshes that are too coarse where the golden's own element errs. A mesh with more elements than a
  /// sufficient one is not worth it: its smallest elements, which determine its step, are also smaller.
  void add_refined() {
    const CandidateMesh& own = choice_.meshes.front();
    const bool own_suffices = evaluator_.evaluate_mesh(own).reason.empty();
    for (const CandidateMesh& mesh : choice_.meshes) {
      if (!mesh.own() || own_suffices) enough_elements_ = std::min(enough_elements_, elements_of(mesh.scene));
    }
    if (!own_suffices) too_coarse_.emplace_front("", own.problem);
    for (const auto& [difference, problem] : too_coarse_) refine_until_near(difference, problem);
  }

 private:
  /// Refinements after which a mesh is abandoned.
  static constexpr int most_refinements = 5;

  /// Whether the golden's own element finds an answer on another mesh.
  bool try_out_mesh(const std::string& difference, const CaseOnMesh& problem) {
    Scene scene = make_scene(problem);
    auto reference = interpolate(scene_.mesh, choice_.reference.u, scene.mesh.points);
    return try_out({difference, problem, std::move(scene), std::move(reference)});
  }

  /// Whether the golden's own element finds an answer on a mesh; if so, candidates use it.
  bool try_out(CandidateMesh mesh) {
    choice_.others.push_back({mesh.name(), evaluator_.evaluate_mesh(mesh)});
    MeshAttempt& attempt = choice_.others.back();
    attempt.kept = attempt.evaluation.reason.empty();
    if (attempt.kept) choice_.meshes.push_back(std::move(mesh));
    return attempt.kept;
  }

  /// Also ends if a refinement no longer reduces the error by a tenth: the rest is due to the shape.
  void refine_until_near(const std::string& difference, const CaseOnMesh& start) {
    std::string name = difference;
    const auto done = [&](const auto& search) {
      try {
        search();
        return true;
      } catch (const ComputationError& error) {
        choice_.others.push_back({name + " and further", {{}, {}, {}, error.what()}});
        return false;
      }
    };
    std::optional<RefinedAnswer> answer;
    if (!done([&] { answer.emplace(start, choice_.demand.tolerance, choice_.demand.threads); })) return;
    double before = std::numeric_limits<double>::infinity();
    for (int n = 0; n < most_refinements; ++n) {
      if (!done([&] { answer->refine(); })) return;
      const std::size_t elements = elements_of(answer->scene());
      if (elements >= enough_elements_) return;
      name = fmt::format("{}{}refined to {} elements", difference, difference.empty() ? "" : ", ", elements);
      if (try_out_mesh(name, answer->problem())) {
        enough_elements_ = elements;
        return;
      }
      const double error = choice_.others.back().evaluation.error.value_or(0.0);
      if (error > 0.9 * before) return;
      before = error;
    }
  }

  /// The user's case, with fewer evaluations.
  const Case& own() const { return choice_.meshes.front().problem.description; }

  static std::size_t elements_of(const Scene& scene) { return scene.mesh.cells.size(); }

  const Scene& scene_;
  Choice& choice_;
  Evaluator& evaluator_;
  std::deque<std::pair<std::string, CaseOnMesh>> too_coarse_;  // by their differences from the user's mesh
  std::size_t enough_elements_ = std::numeric_limits<std::size_t>::max();
};

/// The sort key of a candidate: its cost. An adaptive candidate comes after fixed ones that cost up to a
/// tenth more, because fixed elements are simpler.
double rank(const Attempt& attempt) {
  constexpr double price_of_change = 1.1;
  if (!attempt.cost) return std::numeric_limits<double>::infinity();
  const double cost = attempt.cost->per_simulated_second().value_or(std::numeric_limits<double>::infinity());
  return method_named(attempt.candidate.choice.method).adapts() ? price_of_change * cost : cost;
}

/// Why a candidate is too expensive; empty if it is not.
std::string cost_reason(const StepCost& cost, const Demand& demand) {
  if (demand.budget && cost.seconds > *demand.budget) {
    return fmt::format("too expensive: {} takes {:.3g} ms, and may take {:.3g} ms",
                       cost.condensed ? "an answer" : "a step", 1e3 * cost.seconds, 1e3 * *demand.budget);
  }
  if (demand.real_time && cost.per_simulated_second() > 1.0) {
    return fmt::format("not in real time: a simulated second takes {:.3g} s", *cost.per_simulated_second());
  }
  return "";
}

std::vector<Attempt> make_attempts(std::vector<Candidate> candidates, const std::vector<Costing>& costings) {
  std::vector<Attempt> attempts;
  for (std::size_t n = 0; n < candidates.size(); ++n) {
    Attempt attempt{.candidate = std::move(candidates[n]), .cost = costings[n].cost};
    attempt.evaluation.reason = attempt.candidate.unfit;
    if (!attempt.cost && attempt.candidate.unfit.empty()) attempt.evaluation.reason = costings[n].status;
    if (!attempt.evaluation.reason.empty()) attempt.outcome = Outcome::refused;
    attempts.push_back(std::move(attempt));
  }
  std::stable_sort(attempts.begin(), attempts.end(),
                   [](const Attempt& a, const Attempt& b) { return rank(a) < rank(b); });
  return attempts;
}

/// Whether a reference can show an error: not if the truth itself is less accurate.
bool can_show(const Reference& reference, double error) {
  return reference.name != "truth" || reference.own.largest.value_or(0.0) <= error;
}

/// Evaluates candidates, starting with the cheapest.
void try_candidates(Choice& choice, Evaluator& evaluator, const ProgressOf& progress) {
  const Demand& demand = choice.demand;
  for (std::size_t n = 0; n < choice.attempts.size(); ++n) {
    Attempt& attempt = choice.attempts[n];
    if (attempt.outcome == Outcome::refused) continue;
    if (choice.chosen && !demand.all) continue;
    const double share = static_cast<double>(n) / static_cast<double>(choice.attempts.size());
    if (!progress(share, name_of(attempt.candidate)))
      throw ComputationError("choose: interrupted; nothing was written");
    const std::string too_expensive = cost_reason(*attempt.cost, demand);
    if (too_expensive.empty() || demand.all) attempt.evaluation = evaluator.evaluate(attempt.candidate);
    if (!too_expensive.empty()) attempt.evaluation.reason = too_expensive;
    if (attempt.evaluation.reason.empty() && !can_show(choice.reference, demand.tolerance)) {
      attempt.evaluation.reason = "closer to the truth than the error of the truth itself";
    }
    attempt.outcome = attempt.evaluation.reason.empty() ? Outcome::sufficient : Outcome::refused;
    if (attempt.outcome == Outcome::refused || choice.chosen) continue;
    attempt.outcome = Outcome::chosen;
    choice.chosen = n;
  }
}

/// A remark about the error of the reference.
std::string reference_remark(const Choice& choice) {
  const auto& [name, u, unit, own] = choice.reference;
  const double tolerance = choice.demand.tolerance;
  if (name == "truth") {
    if (!own.largest) return fmt::format("the error of the truth itself is not known: {}", own.note);
    return fmt::format("the truth itself is known to {} ({}){}", percentage(*own.largest), own.note,
                       !can_show(choice.reference, tolerance) ? ": smaller errors cannot be shown" : "");
  }
  if (!own.largest) return "";
  return fmt::format(
      "the reference is the best answer on this mesh: it is itself about {} from the limit of finer meshes "
      "({})",
      percentage(*own.largest), own.note);
}

const Attempt* nearest(const Choice& choice) {
  const Attempt* best = nullptr;
  for (const auto& attempt : choice.attempts) {
    const auto& error = attempt.evaluation.error;
    if (error && (best == nullptr || *error < *best->evaluation.error)) best = &attempt;
  }
  return best;
}

}  // namespace

std::string_view name_of(Outcome outcome) {
  switch (outcome) {
    case Outcome::chosen:
      return "chosen";
    case Outcome::sufficient:
      return "sufficient";
    case Outcome::refused:
      return "refused";
    case Outcome::not_tried:
      break;
  }
  return "not tried";
}

Choice choose(const CaseOnMesh& problem, const Demand& demand, const ProgressOf& progress) {
  require_methods(demand);
  const Scene scene = make_scene(problem);
  std::string stage = "reference";
  const Proceed proceed = [&](double share) { return progress(share, stage); };
  Choice choice{.demand = demand, .reference = make_reference(scene, demand.against, proceed), .meshes = {}};
  Evaluator evaluator(scene, choice.reference, demand.tolerance, proceed);
  stage = "other meshes";
  Meshes meshes(problem, scene, choice, evaluator);
  meshes.add_coarser();
  if (!scene.settings.quasi_static) meshes.add_longer_steps();
  if (demand.against == "truth" && scene.settings.quasi_static) meshes.add_refined();
  stage = "time of steps";
  auto candidates = make_candidates(choice.meshes, {demand.methods, demand.tolerance, demand.threads});
  const auto costings = measure_costs(candidates, proceed);
  choice.attempts = make_attempts(std::move(candidates), costings);
  stage = "answers";
  try_candidates(choice, evaluator, progress);
  return choice;
}

std::string percentage(double fraction) {
  return fmt::format("{:.3g} %", 100.0 * fraction);
}

std::vector<std::string> remarks(const Choice& choice) {
  const double tolerance = choice.demand.tolerance;
  std::vector<std::string> said;
  if (const auto remark = reference_remark(choice); !remark.empty()) said.push_back(remark);
  if (choice.chosen) return said;
  const Attempt* best = nearest(choice);
  if (best != nullptr) {
    said.push_back(fmt::format("the most accurate candidate computed is {}, {}: {}; it was rejected: {}",
                               name_of(best->candidate), best->candidate.mesh->name(),
                               percentage(*best->evaluation.error), best->evaluation.reason));
  }
  for (const auto& attempt : choice.attempts) {
    const auto& [candidate, cost, evaluation, outcome] = attempt;
    const bool is_golden = candidate.choice.method == golden_method && candidate.mesh->own() &&
                           candidate.choice.precision == Precision::double_precision;
    if (!is_golden || !evaluation.error || !(*evaluation.error > tolerance)) continue;
    said.push_back(fmt::format(
        "the golden's own element is {} off on this mesh: this error is due to the mesh, and no method can "
        "be more accurate. If errors fall with the square of the element size, about {:.2g} "
        "times as many elements in each direction are needed",
        percentage(*evaluation.error), std::sqrt(*evaluation.error / tolerance)));
  }
  const auto expensive =
      std::count_if(choice.attempts.begin(), choice.attempts.end(), [&](const Attempt& attempt) {
        return attempt.cost && !cost_reason(*attempt.cost, choice.demand).empty() &&
               !attempt.evaluation.error;
      });
  if (expensive > 0)
    said.push_back(fmt::format("{} were too expensive and not computed; --all computes them", expensive));
  return said;
}

}  // namespace sandglass
