#pragma once

#include "solve/mixed_body.hpp"

namespace sandglass {

/// One step of a truncated Newton method down the potential of a body's own forces, or of those with
/// multipliers: conjugate gradients with differences of forces for products with the tangent, preconditioned
/// by a multigrid cycle, until the linear residual has fallen to a tenth or a direction of negative curvature
/// is met; then as far along the step as the potential or the norm of the forces falls sufficiently. Takes at
/// most `most_products` evaluations for the step and a few for its length. Returns false and restores the
/// state when no length will do. Sets `convex` to whether no direction of negative curvature was met.
template <class Real>
bool newton_step(MixedBody<Real>& mixed, const typename MixedBody<Real>::Multipliers* multipliers,
                 int most_products, bool* convex = nullptr);

extern template bool newton_step(MixedBody<double>&, const MixedBody<double>::Multipliers*, int, bool*);
extern template bool newton_step(MixedBody<float>&, const MixedBody<float>::Multipliers*, int, bool*);

}  // namespace sandglass
