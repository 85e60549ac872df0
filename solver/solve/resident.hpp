#pragma once

#include <string>
#include <vector>

#include "assembly/resident.hpp"
#include "solve/leapfrog.hpp"

namespace sandglass {

/// Why the state of a moving body cannot stay on another processor, so that it is copied at every step; empty
/// if it can.
std::string why_not_resident(const Scene& scene);

/// A body that moves on another processor. Steps are collected, and submitted together when the body is
/// needed here.
template <class Real>
class ResidentMotion {
 public:
  ResidentMotion(const Model& model, const StateKeeper<Real>& keeper, const Leapfrog<Real>& leapfrog);

  /// See ResidentState::redirect.
  void redirect(std::span<const typename NodalProblem<Real>::Share> shares) {
    submit();
    state_->redirect(shares);
  }

  /// Starts from the body as it is here; `driving` are the forces (N) that move its constraints.
  void begin(const Body<Real>& body, const std::vector<double>& driving);

  StepTraffic step_traffic() const { return state_->step_traffic(); }

  /// Collects a step. Submits and waits from time to time, as the other processor keeps what is submitted.
  void add(ResidentStep step) {
    constexpr std::size_t most = 1000;
    steps_.push_back(std::move(step));
    if (steps_.size() == most) finish();
  }

  /// Submits what was collected and waits for its end.
  void finish() {
    submit();
    state_->wait();
  }

  /// Submits what was collected and returns whether the elements are healthy after it.
  bool is_healthy();

  /// Brings the body here, at a time (s) and load factor; sets the driving forces and adds the works (J) of
  /// constraints.
  void bring(Body<Real>& body, double factor, double time, std::vector<double>& driving,
             std::vector<double>& works);

 private:
  void submit();

  std::unique_ptr<ResidentState<Real>> state_;
  std::vector<ResidentStep> steps_;
  double last_step_ = 0.0;  // s
  ResidentBody<Real> body_;
};

/// The motion of a model on the processor of its elements; none if they are here, or if the state cannot stay
/// there. Constraints follow the paths of the scene.
template <class Real>
std::unique_ptr<ResidentMotion<Real>> resident_motion(const Model& model, const InternalForce<Real>& elements,
                                                      const Leapfrog<Real>& leapfrog);

extern template class ResidentMotion<double>;
extern template class ResidentMotion<float>;

}  // namespace sandglass
