#pragma once

#include "problem/element_tangents.hpp"
#include "solve/mixed_body.hpp"

namespace sandglass {

/// The tangent stiffness K of a body in stable static equilibrium, and linear problems with it. Products are
/// exact, those of elements in dual numbers. A problem is solved by refinement: the multigrid method of the
/// search, on differences of forces in double precision, gives corrections for the exact residual, which ends
/// below 1e-9.
class StaticTangent {
 public:
  /// At displacements u (m) at the full load; `levels` are those of an adaptive method, else empty. The model
  /// must have a potential, and outlive the tangent.
  StaticTangent(const Model& model, const NodalField& u, std::vector<double> levels);

  /// K a (N) of displacements a (m) of all nodes, without the constraints; the forces on tied nodes are
  /// transferred to the nodes that they follow.
  NodalField product(const NodalField& a) const;

  /// The displacements (m) of free nodes, and of the nodes tied to them, that forces (N) cause: K a = b, zero
  /// on constrained components. Throws ComputationError if K is not positive along a, or if the problem is
  /// not solved, as at a limit of the load.
  NodalField solve(const NodalField& b);

  /// Sets nodes that are tied to the means of those that they follow.
  NodalField followed(const NodalField& a) const;

  /// Forces (N) or derivatives, those of tied nodes transferred to the nodes that they follow.
  NodalField handed_on(const NodalField& forces) const;

  const Model& model() const { return model_; }
  const NodalField& displacements() const { return u_; }
  const std::vector<double>& levels() const { return levels_; }

 private:
  const Layout& layout() const { return mixed_.body().layout(); }
  const MixedBlocks& blocks() const { return mixed_.multigrid().elements().blocks(); }

  /// Adds the stiffness of forces other than dead ones, which is symmetric as they have a potential, times a.
  void add_stiffness_of_loads(const Rows<double>& a, Rows<double>& forces) const;

  /// b - K a on free components.
  Rows<double> residual(const Rows<double>& b, const Rows<double>& a) const;

  /// The norm of forces in the weights of the preconditioner, a root of J.
  double norm(const Rows<double>& forces) const;

  /// An approximate answer for `r`, whose norm is one, that leaves a share of it.
  MixedVector correction(const MixedVector& r, double share_left);
  MixedVector accelerated(const MixedVector& r, double share_left);
  MixedVector conjugate(MixedVector r, double share_left);

  /// Weighted K x of both unknowns, or K x (N) of displacements alone, by a difference of forces.
  MixedVector mixed_product(const MixedVector& x);
  Rows<float> difference_product(const MixedVector& x);

  const Model& model_;
  const NodalField u_;
  const std::vector<double> levels_;
  MixedBody<double> mixed_;
  State<double> state_;
  std::vector<double> pressures_;
  MixedVector residuals_;  // of the equilibrium, weighted
  Rows<double> forces_;    // of the equilibrium, N
};

}  // namespace sandglass
