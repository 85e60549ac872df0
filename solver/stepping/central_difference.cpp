#include "stepping/central_difference.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>

#include "base/error.hpp"
#include "element/methods.hpp"
#include "model/loading.hpp"
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
        explicit_step_(model, elements),
        body_(explicit_step_.body()),
        reactions_(model.scene().constraints.size(), 0.0) {}

  Body<Real>& body() { return body_; }
  double time() const { return time_; }
  long step() const { return step_; }
  double step_size() const { return step_size_; }
  double external_work() const { return work_; }

  /// Starts from the initial velocity: before the first step it is an increment over 1 s.
  void set_initial_velocity() {
    const Vector& v = model_.scene().description.initial_velocity;
    Rows<Real>& increment = body_.state().increment;
    for (std::size_t r = 0; r < increment.size(); ++r) {
      for (std::size_t i = 0; i < 3; ++i) {
        increment[r][i] = explicit_step_.inverse_masses()[r][i] > Real(0) ? static_cast<Real>(v[i]) : Real(0);
      }
    }
    increment_time_ = 1.0;
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
    const double now = loading(time_), before = loading(time_ - step_size_), advance = now - before;
    const auto& constraints = model_.scene().constraints;
    for (std::size_t k = 0; k < constraints.size(); ++k) {
      const double force = body_.reactions()[k] + inertia(constraints[k]);
      work_ += 0.5 * (reactions_[k] + force) * advance * constraints[k].value;
      reactions_[k] = force;
    }
    const double path = body_.load_path();
    work_ += 0.5 * (before + now) * (path - load_path_);
    load_path_ = path;
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
    for (const auto& [node, component, value] : model_.scene().constraints) {
      v[static_cast<std::size_t>(node)][static_cast<std::size_t>(component)] = loading_rate(time_) * value;
    }
    return v;
  }

 private:
  double ramp_time() const { return settings_.ramp_time > 0.0 ? settings_.ramp_time : settings_.duration; }
  double loading(double time) const { return loading_curve(time / ramp_time()); }
  double loading_rate(double time) const { return loading_curve_rate(time / ramp_time()) / ramp_time(); }

  /// Force (N) that accelerates the lumped mass of a driven component.
  double inertia(const Constraint& constraint) const {
    const double T = ramp_time();
    return model_.masses()[static_cast<std::size_t>(constraint.node)] * constraint.value *
           loading_curve_acceleration(time_ / T) / (T * T);
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
  ExplicitStep<Real> explicit_step_;
  Body<Real>& body_;
  std::vector<double> reactions_;
  double time_ = 0.0;  // s, of the displacements
  long step_ = 0;
  double step_size_ = 0.0;       // s, the step that led here
  double increment_time_ = 1.0;  // s, in which the increments came about
  double next_step_ = 0.0;
  double load_path_ = 0.0;
  double work_ = 0.0;
};

template <class Real>
Motion integrate_body(const Model& model, const InternalForce<Real>& elements, Observer& observer) {
  const DynamicsSettings& settings = model.scene().description.dynamics;
  CentralDifference<Real> scheme(model, elements);
  Body<Real>& body = scheme.body();
  Motion motion;
  int frames = 0;

  const auto frame_due = [&] {
    return scheme.finished() || scheme.time() >= frames * settings.duration / settings.frames;
  };
  const auto report = [&] {
    NodalField v = scheme.velocities();
    const StrainEnergies energies = body.energies();
    observer.history({scheme.time(), 0.5 * weighted_dot(model.masses(), v, v), energies.strain,
                      energies.hourglass, scheme.external_work(), body.residual(), scheme.step_size()});
    if (frame_due()) {
      observer.frame(body.frame(scheme.time(), std::move(v)));
      ++frames;
    }
    motion.interrupted = !observer.proceed(scheme.step(), scheme.time() / settings.duration, body.residual());
  };

  const auto start = std::chrono::steady_clock::now();
  scheme.choose_step();
  motion.smallest_step = settings.duration;
  body.evaluate_forces();
  scheme.set_initial_velocity();
  report();
  while (!scheme.finished() && !motion.interrupted) {
    scheme.advance();
    scheme.update_external_work();
    motion.smallest_step = std::min(motion.smallest_step, scheme.step_size());
    if (scheme.step() % settings.check_interval == 0 || frame_due()) {
      body.require_healthy(scheme.step());
      report();
      scheme.choose_step();
    }
  }
  motion.u = body.field(body.state().u);
  motion.v = scheme.velocities();
  motion.time = scheme.time();
  motion.steps = scheme.step();
  motion.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  return motion;
}

}  // namespace

Motion integrate(const Model& model, Observer& observer) {
  if (answers_by_condensation(model.choice().method)) {
    throw InputError(fmt::format(
        "{}: method '{}' has no dynamics: it superposes static answers; use it on quasi-static cases, or "
        "method '{}'",
        model.scene().description.file.string(), model.choice().method, LinearPerturbation::name));
  }
  return std::visit([&](const auto& elements) { return integrate_body(model, *elements, observer); },
                    model.internal_force());
}

}  // namespace sandglass
