#pragma once

#include "solve/mixed_body.hpp"

namespace sandglass {

/// Solves the linearized problem of a body approximately, by accelerated multigrid cycles: x, first the
/// imposed displacements (m), becomes the answer to them and to the loads (N).
template <class Real>
void solve_linearized(MixedBody<Real>& mixed, const MixedVector& loads, MixedVector& x);

extern template void solve_linearized(MixedBody<double>&, const MixedVector&, MixedVector&);
extern template void solve_linearized(MixedBody<float>&, const MixedVector&, MixedVector&);

}  // namespace sandglass
