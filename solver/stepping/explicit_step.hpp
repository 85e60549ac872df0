#pragma once

#include "stepping/body.hpp"

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
  /// + increment; then constrained components go to `loading` times their final values, and the forces are
  /// evaluated there. Allocates nothing.
  void take(double step, double keep, double gain, double loading);

 private:
  Body<Real> body_;
  Rows<Real> inverse_masses_;
};

extern template class ExplicitStep<double>;
extern template class ExplicitStep<float>;

}  // namespace sandglass
