#include "solve/relaxation.hpp"

#include <fmt/format.h>

#include <chrono>
#include <limits>
#include <utility>

#include "assembly/method_entry.hpp"
#include "base/error.hpp"
#include "problem/held.hpp"
#include "solve/adaption.hpp"
#include "solve/augmentation_schedule.hpp"
#include "solve/best_state.hpp"
#include "solve/condensed_answer.hpp"
#include "solve/driving_forces.hpp"
#include "solve/equilibrium.hpp"
#include "solve/frame.hpp"
#include "solve/health.hpp"
#include "solve/load_levels.hpp"
#include "solve/stability.hpp"
#include "solve/stagnation.hpp"

namespace sandglass {

namespace {

/// The search through all load levels, with reports to the observer.
template <class Real>
class Search {
 public:
  Search(const Model& model, const InternalForce<Real>& elements, Observer& observer)
      : model_(model),
        elements_(elements),
        settings_(model.scene().settings.relaxation),
        most_evaluations_(leaves_hourglass_modes(model.choice())
                              ? std::min(few_evaluations, settings_.max_steps)
                              : settings_.max_steps),
        amplification_(std::max(0.0, largest_lambda_over_mu(model.scene().materials))),
        observer_(observer),
        equilibrium_(model, elements),
        adaption_(model, equilibrium_.body()),
        load_levels_(model, equilibrium_.body(), depends_on_path(model, elements)),
        no_velocity_(model.masses().size()),
        driving_(model, equilibrium_.body()),
        next_check_(settings_.check_interval),
        augmentations_(equilibrium_.may_touch()) {}

  Relaxation run(const Checkpoint* from) {
    if (from != nullptr) {
      keep(CheckpointReader(*from));
    } else {
      body().end_level(false);
      observer_.frame(frame_of(body(), 0.0, no_velocity_));
      report();
    }
    while (!ended_) {
      observer_.resumable([this] {
        Checkpoint checkpoint;
        keep(CheckpointWriter(checkpoint));
        return checkpoint;
      });
      load_levels_.predict(equilibrium_);
      if (load_levels_.advances() && is_healthy(body()) && solve() && descend_from_saddles() &&
          stays_outside()) {
        finish_load_level();
      } else if (!ended_) {
        retry_load_level();
      }
    }
    return finish();
  }

  /// The same from displacements near the answer at the full load; none if the search fails.
  std::optional<Relaxation> run_near(const NodalField& u) {
    const Frame rest = frame_of(body(), 0.0, no_velocity_);
    load_levels_.skip_to_end();
    body().state() = state_at(elements_, u);
    body().impose(load_levels_.load());
    if (!is_healthy(body())) return std::nullopt;
    equilibrium_.take_own_pressures();
    const auto& coarser = model_.scene().coarser;
    if (!coarser.empty()) equilibrium_.average_pressures(coarser.front().element_of);
    if (!solve() || (result_.stagnated && !result_.rounded)) return std::nullopt;
    if (!descend_from_saddles() || !stays_outside()) return std::nullopt;
    observer_.frame(rest);
    finish_load_level();
    return finish();
  }

 private:
  /// The residual at which elements first choose their levels at the full load, and contact is first
  /// augmented; levels that would still change at smaller residuals are corrected at the end.
  static constexpr double moderate_tolerance = 1e-3;

  /// Elements without stiffness against hourglass modes have a stable equilibrium on coarse meshes only; the
  /// search for one ends after this many evaluations.
  static constexpr int few_evaluations = 2000;

  /// The largest number of saddles that are left one after another.
  static constexpr int most_saddles = 5;

  static constexpr double epsilon = static_cast<double>(std::numeric_limits<Real>::epsilon());

  Body<Real>& body() { return equilibrium_.body(); }

  Relaxation finish() {
    result_.u = body().field(body().state().u);
    require_apart(model_.scene(), result_.u);
    result_.energies = body().energies();
    result_.steps = equilibrium_.evaluations() + adaption_.evaluations_of_estimates();
    result_.residual = equilibrium_.residual();
    result_.inverted = !is_healthy(body());
    result_.adaption_seconds = adaption_.seconds();
    observer_.frame(frame_of(body(), time(), no_velocity_));
    return std::move(result_);
  }

  /// The data that the next load level depends on; see checkpoint.hpp.
  template <class Archive>
  void keep(Archive archive) {
    equilibrium_.keep(archive);
    load_levels_.keep(archive, body());
    archive("next check", next_check_);
    driving_.keep(archive);
  }

  /// At the full load.
  double tolerance() const {
    double tolerance = settings_.tolerance;
    if (is_unsettled()) tolerance = std::max(tolerance, moderate_tolerance);
    if (!augmentations_.done())
      tolerance = std::max(tolerance, moderate_tolerance * augmentations_.share_of_first_residual());
    return tolerance;
  }

  /// Relative time: the length of the load path, plus, at the full load, further evaluations over the earlier
  /// ones.
  double time() const {
    if (!load_levels_.full()) return load_levels_.travelled();
    const auto before = static_cast<double>(std::max(1L, first_evaluation_));
    return load_levels_.way() + static_cast<double>(equilibrium_.evaluations() - first_evaluation_) / before;
  }

  /// Searches for the equilibrium at this load; returns whether it was found, within the tolerance or
  /// roundoff, without inverted elements. A search that stagnates starts once more, without the roundoff of
  /// its earlier steps.
  bool solve() {
    first_evaluation_ = equilibrium_.evaluations();
    equilibrium_.start(load_levels_.effort());
    return search();
  }

  /// The same for a search that has been started.
  bool search() {
    Stagnation stagnation(epsilon, amplification_);
    int stagnations = 0;
    BestState<Real> best;
    int augmentations = augmentations_.count();
    result_.stagnated = result_.rounded = false;
    while (!arrived() || settle()) {
      if (std::exchange(augmentations, augmentations_.count()) != augmentations_.count()) {
        stagnation = Stagnation(epsilon, amplification_);
        best = {};
      }
      check();
      if (ended_) return false;
      if (!equilibrium_.step() && !stagnation.at_roundoff()) return false;
      stagnation.take(equilibrium_.residual(), at_rounding());
      if (stagnation.at_roundoff() && !elements_.needs_increment()) best.take(equilibrium_);
      if (!stagnation.reached()) continue;
      // In single precision a second attempt gets closer.
      if (++stagnations > 1 || (std::is_same_v<Real, double> && at_rounding())) {
        if (!settle() && !augment()) break;
        stagnations = 0;
      }
      stagnation = Stagnation(epsilon, amplification_);
      equilibrium_.start(load_levels_.effort());
    }
    if (!near() && !at_rounding() && best.restore(equilibrium_)) equilibrium_.start(load_levels_.effort());
    const bool healthy = is_healthy(body());
    result_.stagnated = healthy && !near();
    const bool single = std::is_same_v<Real, float>;
    result_.rounded = result_.stagnated && (at_rounding() || (single && equilibrium_.contact_agrees() &&
                                                              stagnation.reaches(equilibrium_.residual())));
    return healthy;
  }

  /// At the full load, leaves equilibria whose tangent has a negative eigenvalue, until a minimum of the
  /// potential is found; false if the run ends.
  bool descend_from_saddles() {
    if (!load_levels_.full() || (result_.stagnated && !result_.rounded)) return true;
    result_.why_not_decided = why_not_decided(model_, elements_.needs_increment());
    if (!result_.why_not_decided.empty()) return true;
    result_.stability = Stability::stable;
    if (method_named(model_.choice().method).is_linear) return true;
    for (int left = 0;; ++left) {
      const SoftestMotions softest = equilibrium_.softest_motions(model_.scene().mesh.points);
      result_.stability_evaluations += softest.evaluations;
      if (softest.resists()) return true;
      if (softest.falling.empty()) {
        result_.stability = Stability::not_decided;
        result_.why_not_decided = fmt::format(
            "the smallest eigenvalue, {:.1g} of the initial stiffness, may be rounding", softest.least);
        return true;
      }
      result_.stability = Stability::saddle_left;
      augmentations_.restart();
      if (left == most_saddles || !equilibrium_.leave(softest.falling, left > 0) || (!search() && !ended_)) {
        throw ComputationError(
            fmt::format("the equilibrium found is unstable: the smallest eigenvalue of the current stiffness "
                        "is {:.2g} of the initial one; descending from it found no other; remedy: a small "
                        "force that selects a direction, or a damped motion",
                        softest.least),
            Breakdown::no_balance);
      }
      if (ended_) return false;
    }
  }

  /// Whether the residual forces may be rounding, of displacements or of J - 1, and are small compared with
  /// reactions and loads, or these are rounding too. With a tolerance below that of double precision, the
  /// search continues as far as it can.
  bool at_rounding() {
    constexpr double most_residual = 0.01, double_precision = std::numeric_limits<double>::epsilon();
    if (settings_.tolerance < double_precision || !equilibrium_.contact_agrees()) return false;
    const double residual = equilibrium_.residual();
    if (residual < 8.0 * double_precision * amplification_) return true;
    return equilibrium_.at_rounding() && (residual < most_residual || equilibrium_.bears_nothing());
  }

  /// Whether elements have not yet chosen their levels.
  bool is_unsettled() const { return adaption_.active() && !settled_; }

  /// Augments contact near the equilibrium at the full load, only once before elements have chosen their
  /// levels; returns whether the search must continue.
  bool augment() {
    if (!load_levels_.full() || augmentations_.done() || (is_unsettled() && augmentations_.count() > 0))
      return false;
    const bool changed = body().augment_contact(augmentations_.next());
    augmentations_.augmented(changed);
    if (changed) equilibrium_.start(load_levels_.effort());
    return changed;
  }

  /// Whether the search may end: not with an inverted element, as another equilibrium may be near, and at the
  /// full load with the nodes that touch obstacles there, after contact is augmented.
  bool arrived() {
    if (load_levels_.full() && equilibrium_.residual() < tolerance()) equilibrium_.update_contact();
    const auto found = [this] { return near() || (at_rounding() && equilibrium_.bears_nothing()); };
    if (!found() || !is_healthy(body())) return false;
    return !augment() && found();
  }

  bool near() const {
    return load_levels_.full() ? equilibrium_.residual() < tolerance() && equilibrium_.contact_agrees()
                               : load_levels_.far_enough(equilibrium_);
  }

  /// Chooses the levels of elements at the current displacements; returns whether the search must continue.
  /// At the full load this is repeated, first at a moderate residual, then at the tolerance, until levels no
  /// longer change and the error of the whole is as requested. Elements are demoted only the first time, so
  /// that promotions end.
  bool settle() {
    if (!load_levels_.full()) {
      adaption_.apply(body(), Demotion::reluctant);
      return false;
    }
    Adaptation changes = adaption_.apply(body(), lowered_ ? Demotion::never : Demotion::where_enough);
    lowered_ = true;
    if (changes.promoted + changes.demoted == 0) {
      if (!adaption_.active() || !std::exchange(settled_, true)) return adaption_.active();
      if (!adaption_.promote_for_the_whole(body())) return false;
    }
    if (settled_) augmentations_.restart();
    equilibrium_.start(load_levels_.effort());
    return true;
  }

  /// Ends contact's load level; returns whether no node may have passed through. Shorter levels help.
  bool stays_outside() {
    through_ = body().end_level(load_levels_.may_shorten());
    if (through_.passed < 0) return true;
    load_levels_.note_corner();
    return false;
  }

  void finish_load_level() {
    result_.converged = load_levels_.full() && !result_.stagnated;
    ended_ = load_levels_.full() || equilibrium_.evaluations() >= most_evaluations_;
    driving_.move(load_levels_.moved());
    driving_.add_work();
    body().add_work_of_loads();
    report();
    if (ended_) return;
    observer_.frame(frame_of(body(), load_levels_.travelled(), no_velocity_));
    load_levels_.solved(equilibrium_);
    if (!ended_ && !load_levels_.has_more()) {
      throw ComputationError(
          fmt::format("more than a thousand load levels beyond the requested ones; the last equilibrium is "
                      "at {:.6g} of the load; remedy: impose less, or refine the mesh",
                      load_levels_.solved_load()),
          Breakdown::no_balance);
    }
  }

  void retry_load_level() {
    const State<Real> failed = body().state();
    const Touch through = std::exchange(through_, {});
    body().augment_contact(Augmentation::none);
    if (augmentations_.restart() > 1 && through.passed < 0) {
      augmentations_.limit_to_one();
      return load_levels_.restart(body());
    }
    if (load_levels_.failed(body())) return;
    body().state() = failed;
    require_not_passed(through, model_.scene().mesh.points, "load", load_levels_.load());
    const std::string where =
        fmt::format("the last equilibrium is at {:.6g} of the load", load_levels_.solved_load());
    try {
      require_healthy(body(), equilibrium_.evaluations());
    } catch (const ComputationError& error) {
      throw ComputationError(fmt::format("{}; {}", error.what(), where), error.breakdown());
    }
    throw ComputationError(
        fmt::format("no static equilibrium found even with tiny increments of the load; {}{}; remedy: impose "
                    "less, or refine the mesh",
                    where,
                    remember_path(model_.scene().forces)
                        ? "; or friction cannot hold the body, or a level of the load is too large"
                        : ""),
        Breakdown::no_balance);
  }

  /// Ends the run if the observer requests it or the evaluations are used up.
  void check() {
    const long evaluations = equilibrium_.evaluations();
    ended_ = evaluations >= most_evaluations_;
    const double residual = equilibrium_.residual();
    observer_.at_load(load_levels_.load());
    const bool proceeds =
        observer_.proceed(evaluations, load_levels_.progress(residual, settings_.tolerance), residual);
    if (evaluations < next_check_) return;
    next_check_ = evaluations + settings_.check_interval;
    if (load_levels_.full()) report();
    result_.interrupted = model_.choice().ranks->any(!proceeds);
    ended_ = ended_ || result_.interrupted;
  }

  void report() {
    const StrainEnergies energies = body().energies();
    const Touch touch = body().touch();
    observer_.history({equilibrium_.evaluations() == 0 ? 0.0 : time(), 0.0, energies.strain,
                       energies.hourglass, body().work_of_loads() + driving_.work(), equilibrium_.residual(),
                       load_levels_.increment(), 0.0, body().reactions_of_sets(), touch.stored,
                       touch.dissipated, touch.depth, body().moments_of_obstacles()});
  }

  const Model& model_;
  const InternalForce<Real>& elements_;
  const RelaxationSettings& settings_;
  int most_evaluations_;
  double amplification_;
  Observer& observer_;
  Equilibrium<Real> equilibrium_;
  Adaption<Real> adaption_;
  LoadLevels<Real> load_levels_;
  NodalField no_velocity_;
  Relaxation result_;
  DrivingForces<Real> driving_;
  long first_evaluation_ = 0;           // of this load level
  long next_check_;                     // evaluations
  bool lowered_ = false;                // whether elements could be demoted at the full load
  bool settled_ = false;                // whether levels no longer changed at a moderate residual
  AugmentationSchedule augmentations_;  // of contact, at this load level
  Touch through_;                       // how a node touched that passed through in this load level
  bool ended_ = false;
};

}  // namespace

Relaxation relax(const Model& model, Observer& observer, const Checkpoint* from, const NodalField* near) {
  require_static_contact(model.scene());
  require_held(model.scene());
  const auto search = [&]<class Real>(const std::unique_ptr<InternalForce<Real>>& elements) {
    if (near != nullptr && !depends_on_path(model, *elements)) {
      if (auto found = Search<Real>(model, *elements, observer).run_near(*near)) return std::move(*found);
    }
    return Search<Real>(model, *elements, observer).run(from);
  };
  const bool condensed = method_named(model.choice().method).is_condensed;
  const auto start = std::chrono::steady_clock::now();
  Relaxation result =
      condensed ? condensed_answer(model, observer) : std::visit(search, model.internal_force());
  result.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  return result;
}

}  // namespace sandglass
