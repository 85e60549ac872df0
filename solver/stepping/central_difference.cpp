#include "stepping/central_difference.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>

#include "base/error.hpp"
#include "model/loading.hpp"
#include "stepping/field.hpp"
#include "stepping/forces.hpp"
#include "stepping/health.hpp"
#include "stepping/stable_step.hpp"

namespace sandglass {

namespace {

/// State of central differences: displacements at `time`, velocities half a step earlier.
struct DynamicState {
  double time = 0.0;  ///< s
  long step = 0;
  double step_size = 0.0;   ///< s, the step that led here
  NodalField u;             ///< m, at `time`
  NodalField v_half;        ///< m/s, at `time - step_size / 2`
  NodalField acceleration;  ///< m/s^2, at `time`; zero on constrained components
};

/// The recipe's quantities, one function each; the order of calls is in `integrate`.
class CentralDifference {
 public:
  explicit CentralDifference(const Model& model)
      : model_(model),
        settings_(model.scene().description.dynamics),
        forces_(model),
        reactions_(model.scene().constraints.size(), 0.0) {
    const std::size_t n = model.masses().size();
    state_.u.resize(n);
    state_.v_half.assign(n, model.scene().description.initial_velocity);
    state_.acceleration.resize(n);
    model.clear_constrained(state_.v_half);
  }

  const DynamicState& state() const { return state_; }
  double residual() const { return forces_.residual(); }
  double external_work() const { return work_; }

  /// The next step: the user's, refused when unsafe, or a share of the stable one.
  void choose_step() {
    const StableStep stable = stable_step(model_, state_.u);
    if (settings_.time_step > 0.0) {
      require_stable(stable);
      next_step_ = settings_.time_step;
    } else {
      next_step_ = settings_.step_fraction * stable.step;
    }
  }

  /// Whether the end is reached, up to the rounding of a sum of steps.
  bool finished() const { return state_.time >= settings_.duration * (1.0 - 1e-12); }

  void update_accelerations() {
    forces_.evaluate(state_.u);
    const auto& masses = model_.masses();
    for (std::size_t n = 0; n < masses.size(); ++n) {
      for (std::size_t i = 0; i < 3; ++i) state_.acceleration[n][i] = -forces_.free()[n][i] / masses[n];
    }
  }

  /// v(t + dt/2) from v(t - dt_old/2): the two half steps share the acceleration and the damping at t.
  /// The last step is cut so that the run ends at its duration.
  void update_velocities() {
    next_step_ = std::min(next_step_, settings_.duration - state_.time);
    const double dt = 0.5 * (state_.step_size + next_step_);
    const double c = 0.5 * settings_.damping * dt;
    for (std::size_t n = 0; n < state_.u.size(); ++n) {
      for (std::size_t i = 0; i < 3; ++i) {
        state_.v_half[n][i] = ((1.0 - c) * state_.v_half[n][i] + dt * state_.acceleration[n][i]) / (1.0 + c);
      }
    }
    state_.step_size = next_step_;
  }

  void update_displacements() {
    for (std::size_t n = 0; n < state_.u.size(); ++n) {
      for (std::size_t i = 0; i < 3; ++i) state_.u[n][i] += state_.step_size * state_.v_half[n][i];
    }
    state_.time += state_.step_size;
    ++state_.step;
  }

  void impose_displacements() { model_.impose(loading(state_.time), state_.u); }

  /// Work of the imposed displacements over the last step, from the mean of the forces at its ends.
  void update_external_work() {
    const double advance = loading(state_.time) - loading(state_.time - state_.step_size);
    const auto& constraints = model_.scene().constraints;
    for (std::size_t k = 0; k < constraints.size(); ++k) {
      const double force = forces_.reactions()[k] + inertia(constraints[k]);
      work_ += 0.5 * (reactions_[k] + force) * advance * constraints[k].value;
      reactions_[k] = force;
    }
  }

  /// Velocities at the time of the displacements: the mean of the half steps before and after, damping
  /// included.
  NodalField velocities() const {
    NodalField v = state_.v_half;
    const double half = 0.5 * state_.step_size;
    for (std::size_t n = 0; n < v.size(); ++n) {
      for (std::size_t i = 0; i < 3; ++i) {
        v[n][i] = (v[n][i] + half * state_.acceleration[n][i]) / (1.0 + half * settings_.damping);
      }
    }
    for (const auto& [node, component, value] : model_.scene().constraints) {
      v[static_cast<std::size_t>(node)][static_cast<std::size_t>(component)] =
          loading_rate(state_.time) * value;
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
           loading_curve_acceleration(state_.time / T) / (T * T);
  }

  void require_stable(const StableStep& stable) const {
    if (settings_.time_step <= stable.step) return;
    const std::string text = fmt::format(
        "dynamics.time_step = {:.6g} s is above the stable step {:.6g} s, set by element {} at step {}; "
        "allowed: at "
        "most the stable step, or 0 to let the program choose",
        settings_.time_step, stable.step, stable.element, state_.step);
    if (state_.step == 0)
      throw InputError(fmt::format("{}: {}", model_.scene().description.file.string(), text));
    throw ComputationError(text);
  }

  const Model& model_;
  const DynamicsSettings& settings_;
  DynamicState state_;
  Forces forces_;
  std::vector<double> reactions_;
  double next_step_ = 0.0;
  double work_ = 0.0;
};

}  // namespace

Motion integrate(const Model& model, Observer& observer) {
  const DynamicsSettings& settings = model.scene().description.dynamics;
  CentralDifference scheme(model);
  const DynamicState& state = scheme.state();
  Motion motion;
  int frames = 0;

  const auto report = [&] {
    const NodalField v = scheme.velocities();
    const StrainEnergies energies = model.internal_force().energies(state.u);
    observer.history({state.time, 0.5 * weighted_dot(model.masses(), v, v), energies.strain,
                      energies.hourglass, scheme.external_work(), scheme.residual(), state.step_size});
    if (scheme.finished() || state.time >= frames * settings.duration / settings.frames) {
      observer.frame(state.time, state.u, v);
      ++frames;
    }
    motion.interrupted = !observer.proceed(state.step, state.time / settings.duration, scheme.residual());
  };

  const auto start = std::chrono::steady_clock::now();
  scheme.choose_step();
  motion.smallest_step = settings.duration;
  scheme.update_accelerations();
  report();
  while (!scheme.finished() && !motion.interrupted) {
    scheme.update_velocities();
    scheme.update_displacements();
    scheme.impose_displacements();
    scheme.update_accelerations();
    scheme.update_external_work();
    motion.smallest_step = std::min(motion.smallest_step, state.step_size);
    const bool frame_due = state.time >= frames * settings.duration / settings.frames;
    if (state.step % settings.check_interval == 0 || frame_due || scheme.finished() ||
        !std::isfinite(scheme.residual())) {
      require_healthy(model, state.u, state.step);
      report();
      scheme.choose_step();
    }
  }
  motion.u = state.u;
  motion.v = scheme.velocities();
  motion.time = state.time;
  motion.steps = state.step;
  motion.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  return motion;
}

}  // namespace sandglass
