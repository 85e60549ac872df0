#pragma once

#include "solve/body.hpp"

namespace sandglass {

/// The step that a dynamic run repeats: one pass over the nodes, the imposed displacements, the forces. What
/// chooses its coefficients stands in central_difference.cpp; what times it, in benchmark/.
template <class Real>
class ExplicitStep {
 public:
  ExplicitStep(const Model& model, const InternalForce<Real>& elements);

  Body<Real>& body() { return body_; }
  const Body<Real>& body() const { return body_; }

  /// 1/kg of the lumped masses, zero where a component may not move.
  const Rows<Real>& inverse_masses() const { return inverse_masses_; }

  /// One step of `step` s: increment := keep * increment - gain * force / mass, with gain in s^2, and u := u
  /// + increment; then `impose(body)` sets constrained components and loads, and the forces are evaluated
  /// there. Allocates nothing.
  template <class Impose>
  void take(double step, double keep, double gain, const Impose& impose) {
    move(step, keep, gain);
    impose(body_);
    body_.evaluate_forces();
  }

 private:
  void move(double step, double keep, double gain);

  Body<Real> body_;
  Rows<Real> inverse_masses_;
};

extern template class ExplicitStep<double>;
extern template class ExplicitStep<float>;

}  // namespace sandglass
