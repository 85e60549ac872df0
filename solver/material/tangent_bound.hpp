#pragma once

#include "math/matrix.hpp"
#include "math/strain.hpp"

namespace sandglass {

/// A bound of a law's tangent in the current configuration: for a further displacement with spatial gradient
/// L the second variation of the energy density (per reference volume, Pa) is at most
///   d^2 W <= volumetric (tr L)^2 + gradient |L|^2.
/// At rest, isotropic: volumetric = lambda, gradient = 2 mu. It gives the wave speed and the stable step.
template <class T>
struct TangentBound {
  T volumetric;
  T gradient;
};

/// The bound of U(J) with p = U' and bulk = U'': d^2 U = bulk (J tr L)^2 + p J ((tr L)^2 - tr(L L)).
template <class T>
TangentBound<T> volumetric_tangent_bound(const T& J, const T& p, const T& bulk) {
  return {.volumetric = bulk * J * J + p * J, .gradient = abs(p * J)};
}

/// The bound of a whole law at the displacement gradient H.
template <class Law, class T>
TangentBound<T> tangent_bound(const Law& law, const Tensor<T>& H) {
  const T J_minus_one = jacobian_minus_one(H);
  const auto iso = law.isochoric_tangent_bound(H);
  const auto vol =
      volumetric_tangent_bound(T(1) + J_minus_one, law.pressure(J_minus_one), law.bulk_tangent(J_minus_one));
  return {.volumetric = iso.volumetric + vol.volumetric, .gradient = iso.gradient + vol.gradient};
}

/// volumetric |g|^2 + gradient lambda_max(g^T g) for shape gradients g (1/m): the largest eigenvalue per
/// volume that a tangent bound allows, from (tr L)^2 <= |g|^2 |v|^2 and |L|^2 <= lambda_max |v|^2 for L = v^T
/// g.
template <class T>
T gradient_bound(const TangentBound<T>& bound, const NodalVectors<T>& g) {
  const Tensor<T> G = transpose(g) * g;
  return max(bound.volumetric, T(0)) * trace(G) + bound.gradient * largest_eigenvalue_bound(G);
}

}  // namespace sandglass
