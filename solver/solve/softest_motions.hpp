#pragma once

#include "solve/mixed_body.hpp"

namespace sandglass {

/// The softest small motions of a body in static equilibrium.
struct SoftestMotions {
  double least = 0.0;     ///< the smallest eigenvalue of its tangent over the stiffness of the model problem
  double error = 0.0;     ///< of the smallest eigenvalue
  double resolved = 0.0;  ///< an eigenvalue below this may be rounding
  long evaluations = 0;
  std::vector<MixedVector> falling;  ///< motions along which the potential falls, the steepest first

  bool resists() const { return least > resolved && least > 2.0 * error; }
};

/// Computes the smallest eigenvalue of the tangent stiffness over the stiffness of the multigrid method's
/// model problem, as accurately as its sign needs. See README.md, "Stability". Forces must have a potential.
/// The last evaluation must be the answer, which does not change.
template <class Real>
SoftestMotions softest_motions(MixedBody<Real>& mixed, const NodalField& points);

extern template SoftestMotions softest_motions(MixedBody<double>&, const NodalField&);
extern template SoftestMotions softest_motions(MixedBody<float>&, const NodalField&);

}  // namespace sandglass
