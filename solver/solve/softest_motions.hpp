#pragma once

#include "solve/mixed_body.hpp"

namespace sandglass {

/// How a body at rest resists small motions.
struct SoftestMotions {
  double least = 0.0;     ///< the smallest eigenvalue of its tangent over the stiffness of the model problem
  double error = 0.0;     ///< of it
  double resolved = 0.0;  ///< below it, an eigenvalue may be rounding
  long evaluations = 0;
  std::vector<MixedVector> falling;  ///< motions along which the potential falls, the steepest first

  bool resists() const { return least > resolved && least > 2.0 * error; }
};

/// Searches the smallest eigenvalue of the tangent stiffness over that of the multigrid method's model
/// problem, as far as its sign needs. See README.md, "Stability". Forces must have a potential, and the last
/// evaluation be that of the answer, which stays.
template <class Real>
SoftestMotions softest_motions(MixedBody<Real>& mixed, const NodalField& points);

extern template SoftestMotions softest_motions(MixedBody<double>&, const NodalField&);
extern template SoftestMotions softest_motions(MixedBody<float>&, const NodalField&);

}  // namespace sandglass
