#pragma once

#include "solve/body.hpp"
#include "solve/largest_frequency.hpp"

namespace sandglass {

/// Throws InputError if the model's method superposes static answers instead of taking steps.
void require_steps(const Model& model);

/// The time of central differences with variable steps and mass-proportional damping. Velocities belong to
/// the time half a step earlier, and are stored as increments of the displacements over `increment_time`.
struct LeapfrogClock {
  double damping;               ///< 1/s
  double time = 0.0;            ///< s, of the displacements
  long step = 0;                ///< taken so far
  double step_size = 0.0;       ///< s, of the last step
  double increment_time = 1.0;  ///< s

  /// The coefficients of a step: the increment becomes keep * increment - gain * force / mass, gain in s^2.
  struct Coefficients {
    double keep;
    double gain;
  };

  /// Advances by `next_step` (s): v(t + dt/2) from v(t - dt_old/2). Both half steps use the acceleration and
  /// the damping at t.
  Coefficients advance(double next_step) {
    const double dt = 0.5 * (step_size + next_step);
    const double c = 0.5 * damping * dt;
    const Coefficients coefficients{(1.0 - c) / (1.0 + c) * next_step / increment_time,
                                    dt / (1.0 + c) * next_step};
    step_size = next_step;
    increment_time = next_step;
    time += step_size;
    ++step;
    return coefficients;
  }
};

/// Central differences with lumped masses and variable steps. Displacements are at `time`, velocities half a
/// step earlier. A copy is an independent simulation of the same model.
template <class Real>
class Leapfrog {
 public:
  /// Starts undeformed, with zero velocities. `damping` is mass-proportional, 1/s.
  Leapfrog(const Model& model, const InternalForce<Real>& elements, double damping);

  Body<Real>& body() { return body_; }
  const Body<Real>& body() const { return body_; }

  /// Of nodes (1/kg), zero on constrained components and tied nodes.
  const Rows<Real>& inverse_masses() const { return inverse_masses_; }

  /// See Body::subcycle.
  void subcycle(const Model& model) { body_.subcycle(model, inverse_masses_); }

  /// The stable step, by bounds of elements or, where the case says so, by the largest frequency of the body;
  /// at most 1 / damping. `given_step` (s) is the one that a user demands, or 0.
  StableStep stable_step(const Model& model, double given_step = 0.0);

  double time() const { return clock_.time; }  ///< s, of the displacements
  long step() const { return clock_.step; }
  double step_size() const { return clock_.step_size; }  ///< s, the step that led here

  /// Sets velocities (m/s) before the first step, stored as increments over 1 s; an empty field means zero.
  /// They do not apply to constrained components.
  void set_initial_velocities(const NodalField& v);

  /// Advances by `next_step` (s), then evaluates the forces. `impose(body)` sets constrained components and
  /// loads at the new time.
  template <class Impose>
  void advance(double next_step, const Impose& impose) {
    take(next_step, clock_.advance(next_step), impose);
  }

  /// Advances the time alone: another processor takes the step with these coefficients.
  LeapfrogClock::Coefficients tick(double next_step) { return clock_.advance(next_step); }

  /// A step of `step` s with given coefficients; suite/benchmark/ measures its time. Allocates nothing.
  template <class Impose>
  void take(double step, LeapfrogClock::Coefficients coefficients, const Impose& impose) {
    move(step, coefficients);
    impose(body_);
    body_.push_out(inverse_masses_, coefficients.gain);
    body_.evaluate_forces();
  }

  /// Velocities (m/s) at the time of the displacements: the mean of those half a step before and after,
  /// damping included; zero on constrained components. Contact that moves nodes acts in the step after, which
  /// is not known yet: with the pushes of the step before, or without any.
  NodalField free_velocities(bool with_pushes) const;

  /// The excess (J) of the kinetic energy of `free_velocities`, without pushes, over half the product of
  /// masses and velocities half a step before and after: an eighth of the product with their change.
  double energy_of_step() const;

  /// The data that the next step depends on; see checkpoint.hpp.
  template <class Archive>
  void keep(Archive& archive) {
    body_.keep(archive);
    largest_frequency_.keep(archive);
    archive("time", clock_.time);
    archive("step", clock_.step);
    archive("step size", clock_.step_size);
    archive("increment time", clock_.increment_time);
  }

 private:
  void move(double step, LeapfrogClock::Coefficients coefficients);

  Body<Real> body_;
  LargestFrequency<Real> largest_frequency_;
  Rows<Real> inverse_masses_;  // of nodes (1/kg), zero on constrained components
  LeapfrogClock clock_;
};

extern template class Leapfrog<double>;
extern template class Leapfrog<float>;

}  // namespace sandglass
