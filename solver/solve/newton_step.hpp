#pragma once

#include "solve/mixed_body.hpp"

namespace sandglass {

/// One step of a truncated Newton method down the potential of a body's forces, its own or with multipliers.
/// Conjugate gradients, with differences of forces for products with the tangent and a multigrid cycle as
/// preconditioner, run until the linear residual has fallen to a tenth or a direction of negative curvature
/// is met; then a line search makes the potential or the norm of the forces fall sufficiently. Takes at most
/// `most_products` evaluations for the step and a few for its length. Returns false and restores the state if
/// no length suffices. Sets `convex` to whether no direction of negative curvature was met.
template <class Real>
bool newton_step(MixedBody<Real>& mixed, const typename MixedBody<Real>::Multipliers* multipliers,
                 int most_products, bool* convex = nullptr);

extern template bool newton_step(MixedBody<double>&, const MixedBody<double>::Multipliers*, int, bool*);
extern template bool newton_step(MixedBody<float>&, const MixedBody<float>::Multipliers*, int, bool*);

}  // namespace sandglass
