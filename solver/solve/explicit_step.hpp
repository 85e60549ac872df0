#pragma once

#include "solve/body.hpp"

namespace sandglass {

/// One step of a dynamic run: a pass over the nodes, the imposed displacements, the forces. Leapfrog chooses
/// its coefficients; suite/benchmark/ measures its time.
template <class Real>
class ExplicitStep {
 public:
  /// For the undeformed body of the model.
  ExplicitStep(const Model& model, const InternalForce<Real>& elements);

  Body<Real>& body() { return body_; }
  const Body<Real>& body() const { return body_; }

  /// Inverse lumped masses, 1/kg; zero on constrained components.
  const Rows<Real>& inverse_masses() const { return inverse_masses_; }

  /// Takes a step of `step` s: increment := keep * increment - gain * force / mass, with gain in s^2, and
  /// u := u + increment; then `impose(body)` sets constrained components and loads, and the forces are
  /// evaluated. Allocates nothing.
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
