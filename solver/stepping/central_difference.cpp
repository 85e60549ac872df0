#include "stepping/central_difference.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>

#include "base/error.hpp"
#include "model/loading.hpp"
#include "model/method_entry.hpp"
#include "stepping/adaption.hpp"
#include "stepping/explicit_step.hpp"
#include "stepping/field.hpp"
#include "stepping/stable_step.hpp"

namespace sandglass {

namespace {

/// The recipe's quantities, one function each; the order of calls is in `integrate_body`. Velocities stand
/// half a step before the displacements, as increments over `increment_time_`.
template <class Real>
class CentralDifference {
 public:
  CentralDifference(const Model& model, const InternalForce<Real>& elements)
      : model_(model),
        settings_(model.scene().description.dynamics),
        layout_(elements.layout()),
        explicit_step_(model, elements),
        body_(explicit_step_.body()),
        reactions_(model.scene().constraints.size(), 0.0),
        moved_(model.scene().angles.size()),
        accelerations_(moved_.size()) {}

  Body<Real>& body() { return body_; }
  double time() const { return time_; }
  long step() const { return step_; }
  double step_size() const { return step_size_; }
  double external_work() const { return work_; }
  double adaption_energy() const { return adaption_energy_; }

  /// What the next step reads; see checkpoint.hpp.
  template <class Archive>
  void keep(Archive& archive) {
    body_.keep(archive);
    archive("reaction", reactions_);
    archive("time", time_);
    archive("step", step_);
    archive("step size", step_size_);
    archive("increment time", increment_time_);
    archive("next step", next_step_);
    archive("load path", load_path_);
    archive("work", work_);
    archive("adaption energy", adaption_energy_);
  }

  /// Starts from the initial velocities: before the first step they are increments over 1 s.
  void set_initial_velocities() {
    const NodalField& v = model_.scene().initial_velocities;
    if (v.empty()) return;
    Rows<Real>& increment = body_.state().increment;
    increment = to_rows<Real>(v, layout_);
    for (std::size_t r = 0; r < increment.size(); ++r) {
      for (std::size_t i = 0; i < 3; ++i) {
        if (!(explicit_step_.inverse_masses()[r][i] > Real(0))) increment[r][i] = Real(0);
      }
    }
  }

  /// The next step: the user's, refused when unsafe, or a share of the stable one.
  void choose_step() {
    const StableStep stable = stable_step(model_, body_.stiffness_bounds());
    if (settings_.time_step > 0.0) {
      require_stable(stable);
      next_step_ = settings_.time_step;
    } else {
      next_step_ = settings_.step_fraction * stable.step;
    }
  }

  /// Whether the end is reached, up to the rounding of a sum of steps.
  bool finished() const { return time_ >= settings_.duration * (1.0 - 1e-12); }

  /// v(t + dt/2) from v(t - dt_old/2), u(t + dt) with it, and the forces there: the two half steps share the
  /// acceleration and the damping at t. The last step is cut so that the run ends at its duration.
  void advance() {
    next_step_ = std::min(next_step_, settings_.duration - time_);
    const double dt = 0.5 * (step_size_ + next_step_);
    const double c = 0.5 * settings_.damping * dt;
    const double keep = (1.0 - c) / (1.0 + c) * next_step_ / increment_time_;
    const double gain = dt / (1.0 + c) * next_step_;
    step_size_ = next_step_;
    increment_time_ = next_step_;
    time_ += step_size_;
    ++step_;
    explicit_step_.take(step_size_, keep, gain, loading(time_));
  }

  /// Work of imposed displacements and forces over the last step, from the mean of the forces at its ends.
  void update_external_work() {
    const double now = loading(time_), before = loading(time_ - step_size_);
    follow_paths(before, now);
    const auto& constraints = model_.scene().constraints;
    for (std::size_t k = 0; k < constraints.size(); ++k) {
      const ImposedPath& path = constraints[k].path;
      const double force = constraint_force(k);
      for (std::size_t i = 0; i < 3; ++i) {
        work_ += 0.5 * (reactions_[k] + force) * moved_[path.angle][i] * path.share[i];
      }
      reactions_[k] = force;
    }
    const double path = body_.load_path();
    work_ += 0.5 * (before + now) * (path - load_path_);
    load_path_ = path;
  }

  /// New levels for the elements, which from now on pull with the forces of these: the energy that they store
  /// more where they stand is none that anything did work for.
  /// Returns whether there were any.
  bool adapt(Adaption<Real>& adaption) {
    const StrainEnergies before = body_.energies();
    if (adaption.apply(body_, Demotion::never).promoted == 0) return false;
    body_.evaluate_forces();
    const StrainEnergies now = body_.energies();
    adaption_energy_ += now.strain + now.hourglass - before.strain - before.hourglass;
    for (std::size_t k = 0; k < reactions_.size(); ++k) {
      reactions_[k] = constraint_force(k);
    }
    return true;
  }

  /// Velocities at the time of the displacements: the mean of the half steps before and after, damping
  /// included.
  NodalField velocities() const {
    const double half = 0.5 * step_size_;
    const Rows<Real>& increment = body_.state().increment;
    const Rows<Real>& force = body_.free_forces();
    const Rows<Real>& inverse_masses = explicit_step_.inverse_masses();
    Rows<Real> rows(increment.size());
    for (std::size_t r = 0; r < rows.size(); ++r) {
      for (std::size_t i = 0; i < 3; ++i) {
        const double v_half = static_cast<double>(increment[r][i]) / increment_time_;
        const double acceleration = -static_cast<double>(inverse_masses[r][i] * force[r][i]);
        rows[r][i] = static_cast<Real>((v_half + half * acceleration) / (1.0 + half * settings_.damping));
      }
    }
    NodalField v = body_.field(rows);
    for (const auto& [node, component, path] : model_.scene().constraints) {
      const double by_factor = path.along(path_rates(model_.scene().angles[path.angle], loading(time_)));
      v[static_cast<std::size_t>(node)][static_cast<std::size_t>(component)] =
          loading_rate(time_) * by_factor;
    }
    return v;
  }

 private:
  double ramp_time() const { return settings_.ramp_time > 0.0 ? settings_.ramp_time : settings_.duration; }
  double loading(double time) const { return loading_curve(time / ramp_time()); }
  double loading_rate(double time) const { return loading_curve_rate(time / ramp_time()) / ramp_time(); }

  /// How the terms of paths changed over the last step, from one load factor to another, and their second
  /// derivatives by relative time.
  void follow_paths(double before, double now) {
    const double rate = loading_curve_rate(time_ / ramp_time());
    const double acceleration = loading_curve_acceleration(time_ / ramp_time());
    for (std::size_t m = 0; m < moved_.size(); ++m) {
      const double angle = model_.scene().angles[m];
      const PathTerms from = path_terms(angle, before), to = path_terms(angle, now);
      const PathTerms first = path_rates(angle, now), second = path_accelerations(angle, now);
      for (std::size_t i = 0; i < 3; ++i) {
        moved_[m][i] = to[i] - from[i];
        accelerations_[m][i] = acceleration * first[i] + rate * rate * second[i];
      }
    }
  }

  /// Force (N) that a constraint exerts: it holds against the body and accelerates the lumped mass.
  double constraint_force(std::size_t k) const {
    return body_.reactions()[k] + inertia(model_.scene().constraints[k]);
  }

  /// Force (N) that accelerates the lumped mass of a driven component.
  double inertia(const Constraint& constraint) const {
    const double mass = model_.masses()[static_cast<std::size_t>(constraint.node)], T = ramp_time();
    double force = 0.0;
    for (std::size_t i = 0; i < 3; ++i) {
      force += mass * constraint.path.share[i] * accelerations_[constraint.path.angle][i];
    }
    return force / (T * T);
  }

  void require_stable(const StableStep& stable) const {
    if (settings_.time_step <= stable.step) return;
    const std::string text = fmt::format(
        "dynamics.time_step = {:.6g} s is above the stable step {:.6g} s, set by element {} at step {}; "
        "allowed: at most the stable step, or 0 to let the program choose",
        settings_.time_step, stable.step, stable.element, step_);
    if (step_ == 0) throw InputError(fmt::format("{}: {}", model_.scene().description.file.string(), text));
    throw ComputationError(text);
  }

  const Model& model_;
  const DynamicsSettings& settings_;
  const Layout& layout_;
  ExplicitStep<Real> explicit_step_;
  Body<Real>& body_;
  std::vector<double> reactions_;
  std::vector<PathTerms> moved_, accelerations_;  // of paths of each angle
  double time_ = 0.0;                             // s, of the displacements
  long step_ = 0;
  double step_size_ = 0.0;       // s, the step that led here
  double increment_time_ = 1.0;  // s, in which the increments came about
  double next_step_ = 0.0;
  double load_path_ = 0.0;
  double work_ = 0.0;
  double adaption_energy_ = 0.0;
};

/// When levels are chosen anew in a motion, counted in checks. To judge them costs about ten steps: as long
/// as elements rise they are judged often, and ever more seldom while none does. Elements only go up: in
/// every vibration one that goes down where its hourglass modes pass through zero, and up again where they
/// are wide, would take energy from nowhere.
class Judgements {
 public:
  bool due() { return ++checks_ >= next_; }

  void done(bool rose) {
    wait_ = rose ? shortest : std::min(2 * wait_, longest);
    next_ = checks_ + wait_;
  }

  template <class Archive>
  void keep(Archive& archive) {
    archive("checks", checks_);
    archive("wait for a judgement", wait_);
    archive("next judgement", next_);
  }

 private:
  static constexpr long shortest = 10, longest = 160;

  long checks_ = 0;
  long wait_ = shortest;
  long next_ = shortest;
};

template <class Real>
Motion integrate_body(const Model& model, const InternalForce<Real>& elements, Observer& observer,
                      const Checkpoint* from) {
  const DynamicsSettings& settings = model.scene().description.dynamics;
  CentralDifference<Real> scheme(model, elements);
  Body<Real>& body = scheme.body();
  Adaption<Real> adaption(model, body);
  Judgements judgements;
  Motion motion;
  int frames = 0;

  const auto frame_due = [&] {
    return scheme.finished() || scheme.time() >= frames * settings.duration / settings.frames;
  };
  const auto report = [&] {
    NodalField v = scheme.velocities();
    const StrainEnergies energies = body.energies();
    observer.history({scheme.time(), 0.5 * weighted_dot(model.masses(), v, v), energies.strain,
                      energies.hourglass, scheme.external_work(), body.residual(), scheme.step_size(),
                      scheme.adaption_energy()});
    if (frame_due()) {
      observer.frame(body.frame(scheme.time(), std::move(v)));
      ++frames;
    }
    motion.interrupted = !observer.proceed(scheme.step(), scheme.time() / settings.duration, body.residual());
  };

  const auto keep = [&](auto archive) {
    scheme.keep(archive);
    archive("frames", frames);
    judgements.keep(archive);
    archive("smallest step", motion.smallest_step);
  };
  const auto checkpoint = [&] {
    Checkpoint state;
    keep(CheckpointWriter(state));
    return state;
  };

  const auto start = std::chrono::steady_clock::now();
  if (from != nullptr) {
    keep(CheckpointReader(*from));
  } else {
    scheme.choose_step();
    motion.smallest_step = settings.duration;
    body.evaluate_forces();
    scheme.set_initial_velocities();
    report();
    observer.resumable(checkpoint);
  }
  while (!scheme.finished() && !motion.interrupted) {
    scheme.advance();
    scheme.update_external_work();
    motion.smallest_step = std::min(motion.smallest_step, scheme.step_size());
    if (scheme.step() % settings.check_interval == 0 || frame_due()) {
      body.require_healthy(scheme.step());
      report();
      if (adaption.active() && judgements.due()) judgements.done(scheme.adapt(adaption));
      scheme.choose_step();
      observer.resumable(checkpoint);
    }
  }
  motion.u = body.field(body.state().u);
  motion.v = scheme.velocities();
  motion.time = scheme.time();
  motion.steps = scheme.step();
  motion.adaption_seconds = adaption.seconds();
  motion.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  return motion;
}

}  // namespace

Motion integrate(const Model& model, Observer& observer, const Checkpoint* from) {
  if (method_named(model.choice().method).is_condensed) {
    throw InputError(fmt::format(
        "{}: method '{}' has no dynamics: it superposes static answers; use it on quasi-static cases, or "
        "method '{}'",
        model.scene().description.file.string(), model.choice().method, "linear"));
  }
  return std::visit([&](const auto& elements) { return integrate_body(model, *elements, observer, from); },
                    model.internal_force());
}

}  // namespace sandglass
