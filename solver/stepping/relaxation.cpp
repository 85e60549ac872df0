#include "stepping/relaxation.hpp"

#include <fmt/format.h>

#include <chrono>
#include <limits>

#include "base/error.hpp"
#include "stepping/condensed_answer.hpp"
#include "stepping/equilibrium.hpp"
#include "stepping/load_levels.hpp"

namespace sandglass {

namespace {

/// The search through all levels, as it is told to the observer.
template <class Real>
class Search {
 public:
  Search(const Model& model, const InternalForce<Real>& elements, Observer& observer)
      : model_(model),
        settings_(model.scene().description.relaxation),
        observer_(observer),
        equilibrium_(model, elements),
        levels_(model, equilibrium_.body()),
        no_velocity_(model.masses().size()),
        reactions_(model.scene().constraints.size(), 0.0) {}

  Relaxation run() {
    observer_.frame(body().frame(0.0, no_velocity_));
    report();
    while (!ended_) {
      levels_.predict(body());
      if (body().healthy() && solve()) {
        finish_level();
      } else if (!ended_) {
        retry_level();
      }
    }
    result_.u = body().field(body().state().u);
    result_.energies = body().energies();
    result_.steps = equilibrium_.evaluations();
    result_.residual = equilibrium_.residual();
    observer_.frame(body().frame(time(), no_velocity_));
    return std::move(result_);
  }

 private:
  /// On the way to the full load this residual is good enough to predict from.
  static constexpr double tolerance_on_the_way = 0.1;

  /// Evaluations after which a level begins anew from where it is, with a new preconditioner; then twice as
  /// many. So it does once when the residual stagnates, which frees it from the rounding of the secants.
  static constexpr long first_renewal = 500;

  static constexpr double epsilon = static_cast<double>(std::numeric_limits<Real>::epsilon());

  Body<Real>& body() { return equilibrium_.body(); }

  double tolerance() const {
    return levels_.full() ? settings_.tolerance : std::max(settings_.tolerance, tolerance_on_the_way);
  }

  /// Relative time: the load, and at full load the evaluations over those that led there.
  double time() const {
    if (!levels_.full()) return levels_.load();
    const auto before = static_cast<double>(std::max(1L, first_evaluation_));
    return 1.0 + static_cast<double>(equilibrium_.evaluations() - first_evaluation_) / before;
  }

  /// Whether the forces at this load are in balance, within the tolerance or the rounding, and no element is
  /// inverted.
  bool solve() {
    first_evaluation_ = equilibrium_.evaluations();
    long renewal = first_renewal;
    int stagnations = 0;
    Stagnation stagnation(epsilon);
    equilibrium_.start();
    while (!(equilibrium_.residual() < tolerance())) {
      check();
      if (ended_) return false;
      const bool late = equilibrium_.evaluations() - first_evaluation_ >= renewal;
      if (stagnation.reached() && ++stagnations > 1) break;
      if ((late || stagnation.reached()) && body().healthy()) {
        if (late) renewal *= 2;
        stagnation = Stagnation(epsilon);
        equilibrium_.restart();
      }
      if (!equilibrium_.step()) return false;
      stagnation.take(equilibrium_.residual());
    }
    result_.stagnated = !(equilibrium_.residual() < tolerance());
    return body().healthy();
  }

  void finish_level() {
    result_.converged = levels_.full() && !result_.stagnated;
    ended_ = levels_.full();
    add_work();
    report();
    if (ended_) return;
    observer_.frame(body().frame(levels_.load(), no_velocity_));
    levels_.solved(body());
  }

  void retry_level() {
    const State<Real> failed = body().state();
    if (levels_.failed(body())) return;
    body().state() = failed;
    body().require_healthy(equilibrium_.evaluations());
    throw ComputationError(
        "the forces found no balance, however short the way; remedy: impose less, or refine the mesh",
        Breakdown::no_balance);
  }

  /// Ends the run when the observer wants it or the evaluations are used up.
  void check() {
    const long evaluations = equilibrium_.evaluations();
    ended_ = evaluations >= settings_.max_steps;
    if (evaluations % settings_.check_interval != 0) return;
    if (levels_.full()) report();
    const double residual = equilibrium_.residual();
    const double digits =
        std::log(std::clamp(residual, settings_.tolerance, 1.0)) / std::log(settings_.tolerance);
    result_.interrupted =
        !observer_.proceed(evaluations, levels_.full() ? 0.3 + 0.7 * digits : 0.3 * levels_.load(), residual);
    ended_ = ended_ || result_.interrupted;
  }

  /// Work of imposed displacements and forces over a level, from the mean of the forces at its ends.
  void add_work() {
    const auto& constraints = model_.scene().constraints;
    for (std::size_t k = 0; k < constraints.size(); ++k) {
      const double force = body().reactions()[k];
      work_ += 0.5 * (reactions_[k] + force) * levels_.increment() * constraints[k].value;
      reactions_[k] = force;
    }
    const double path = body().load_path();
    work_ += (levels_.load() - 0.5 * levels_.increment()) * (path - load_path_);
    load_path_ = path;
  }

  void report() {
    const StrainEnergies energies = body().energies();
    observer_.history({equilibrium_.evaluations() == 0 ? 0.0 : time(), 0.0, energies.strain,
                       energies.hourglass, work_, equilibrium_.residual(), levels_.increment()});
  }

  const Model& model_;
  const RelaxationSettings& settings_;
  Observer& observer_;
  Equilibrium<Real> equilibrium_;
  LoadLevels<Real> levels_;
  NodalField no_velocity_;
  Relaxation result_;
  std::vector<double> reactions_;
  double load_path_ = 0.0;
  double work_ = 0.0;
  long first_evaluation_ = 0;  // of this level
  bool ended_ = false;
};

}  // namespace

bool at_rest(const Relaxation& relaxation, Precision precision) {
  return relaxation.converged || (relaxation.stagnated && precision == Precision::single_precision);
}

std::string outcome(const Relaxation& relaxation, Precision precision) {
  if (relaxation.converged) return "at rest";
  if (relaxation.interrupted) return fmt::format("interrupted at step {}", relaxation.steps);
  if (!relaxation.stagnated) return fmt::format("not at rest after {} steps", relaxation.steps);
  if (at_rest(relaxation, precision)) return "at rest within the rounding of single precision";
  return fmt::format("not at rest: residual stopped falling at {:.1e}", relaxation.residual);
}

Relaxation relax(const Model& model, Observer& observer) {
  const auto start = std::chrono::steady_clock::now();
  Relaxation result = answers_by_condensation(model.choice().method)
                          ? condensed_answer(model, observer)
                          : std::visit(
                                [&]<class Real>(const std::unique_ptr<InternalForce<Real>>& elements) {
                                  return Search<Real>(model, *elements, observer).run();
                                },
                                model.internal_force());
  result.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  if (!(result.step_seconds > 0.0)) {
    result.step_seconds = result.seconds / static_cast<double>(std::max(result.steps, 1L));
  }
  return result;
}

}  // namespace sandglass
