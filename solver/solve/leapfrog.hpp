#pragma once

#include "solve/explicit_step.hpp"

namespace sandglass {

/// Throws InputError if the model's method superposes static answers instead of taking steps.
void require_steps(const Model& model);

/// Central differences with lumped masses and variable steps. Displacements are those at `time`, velocities
/// those half a step before, stored as increments over `increment_time_`. A copy is an independent simulation
/// of the same model.
template <class Real>
class Leapfrog {
 public:
  /// Undeformed and at rest, with the subcycles of the case. `damping` is mass-proportional, 1/s.
  Leapfrog(const Model& model, const InternalForce<Real>& elements, double damping)
      : explicit_step_(model, elements), damping_(damping) {
    body().subcycle(model, explicit_step_.inverse_masses());
  }

  Body<Real>& body() { return explicit_step_.body(); }
  const Body<Real>& body() const { return explicit_step_.body(); }

  /// See Body::stable_step.
  StableStep stable_step(const Model& model, double given_step = 0.0) {
    return body().stable_step(model, explicit_step_.inverse_masses(), given_step);
  }

  double time() const { return time_; }  ///< s, of the displacements
  long step() const { return step_; }
  double step_size() const { return step_size_; }  ///< s, the step that led here

  /// Sets velocities (m/s) before the first step, stored as increments over 1 s; an empty field means at
  /// rest. They do not apply to constrained components.
  void set_initial_velocities(const NodalField& v);

  /// Advances by `next_step` (s): v(t + dt/2) from v(t - dt_old/2), then u(t + dt) and its forces. Both half
  /// steps use the acceleration and the damping at t. `impose(body)` sets constrained components and loads at
  /// the new time.
  template <class Impose>
  void advance(double next_step, const Impose& impose) {
    const double dt = 0.5 * (step_size_ + next_step);
    const double c = 0.5 * damping_ * dt;
    const double keep = (1.0 - c) / (1.0 + c) * next_step / increment_time_;
    const double gain = dt / (1.0 + c) * next_step;
    step_size_ = next_step;
    increment_time_ = next_step;
    time_ += step_size_;
    ++step_;
    explicit_step_.take(step_size_, keep, gain, impose);
  }

  /// Velocities (m/s) at the time of the displacements: the mean of those half a step before and after,
  /// damping included; zero on constrained components.
  NodalField free_velocities() const;

  /// The data that the next step depends on; see checkpoint.hpp.
  template <class Archive>
  void keep(Archive& archive) {
    body().keep(archive);
    archive("time", time_);
    archive("step", step_);
    archive("step size", step_size_);
    archive("increment time", increment_time_);
  }

 private:
  ExplicitStep<Real> explicit_step_;
  double damping_;
  double time_ = 0.0;
  long step_ = 0;
  double step_size_ = 0.0;
  double increment_time_ = 1.0;  // s
};

extern template class Leapfrog<double>;
extern template class Leapfrog<float>;

}  // namespace sandglass
