#pragma once

#include "solve/body.hpp"
#include "solve/conjugate_gradient.hpp"
#include "solve/preconditioner.hpp"

namespace sandglass {

/// The search for the equilibrium of a body at fixed imposed displacements, by preconditioned conjugate
/// gradients. A step takes one evaluation of the forces and two passes over the rows: the first reads the
/// forces f, g and p, the second reads f, g, p and u and writes g, p and u; both read the preconditioner's
/// blocks.
template <class Real>
class Equilibrium {
 public:
  /// For the undeformed body of the model; `start` must follow.
  Equilibrium(const Model& model, const InternalForce<Real>& elements);

  /// The body; its forces and displacements are those of the last evaluation. Callers that move it must set
  /// its increment.
  Body<Real>& body() { return body_; }
  const Body<Real>& body() const { return body_; }

  /// Starts from the present displacements, at which no element may be inverted, with their tangent as
  /// preconditioner. Takes one evaluation.
  void start();

  /// The same with forces that are already evaluated.
  void restart();

  /// Takes one step with one evaluation; false if the forces are not finite for any length of the step.
  bool step();

  /// The residual of the last evaluation; see Body::residual.
  double residual() const { return residual_; }

  /// Evaluations of the forces since construction.
  long evaluations() const { return evaluations_; }

  /// The data that `start` depends on; see checkpoint.hpp.
  template <class Archive>
  void keep(Archive& archive) {
    archive("evaluations", evaluations_);
    body_.keep(archive);
  }

 private:
  void begin();
  void evaluate();
  void compare();
  void advance();
  void retry();

  Body<Real> body_;
  bool tells_increment_;
  Preconditioner<Real> preconditioner_;
  ConjugateGradient method_;
  ConjugateGradient::TrialSums sums_;  // of the last evaluation
  Rows<Real> g_;                       // force at the start of the step, moved there along secants
  Rows<Real> p_;                       // direction
  double length_ = 0.0;                // of the last trial, in p_
  CoarseVector coarse_g_;              // Z^T g
  CoarseVector coarse_d_;
  CoarseVector solved_g_;  // A^-1 Z^T g
  CoarseVector solved_d_;
  double residual_ = 0.0;
  long evaluations_ = 0;
};

extern template class Equilibrium<double>;
extern template class Equilibrium<float>;

}  // namespace sandglass
