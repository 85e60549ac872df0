#pragma once

#include <cmath>

#include "math/matrix.hpp"
#include "math/strain.hpp"

namespace sandglass {

/// A bound of a law's tangent in the current configuration: for a further displacement with spatial gradient
/// L the second variation of the energy density (per reference volume, Pa) is at most
///   d^2 W <= volumetric (tr L)^2 + gradient |L|^2.
/// An undeformed isotropic law has volumetric = lambda, gradient = 2 mu. The wave speed and the stable step
/// follow from it.
template <class T>
struct TangentBound {
  T volumetric;
  T gradient;

  friend TangentBound operator+(const TangentBound& a, const TangentBound& b) {
    return {a.volumetric + b.volumetric, a.gradient + b.gradient};
  }
};

/// The bound of U(J) with p = U' and bulk = U'': d^2 U = bulk (J tr L)^2 + p J ((tr L)^2 - tr(L L)).
template <class T>
TangentBound<T> volumetric_tangent_bound(const T& J, const T& p, const T& bulk) {
  return {.volumetric = bulk * J * J + p * J, .gradient = abs(p * J)};
}

/// The bound of S : d^2 E for E = (J^(-2/3) F^T F - I)/2 and a stress S. With tau = J^(-2/3) F S F^T it is
/// tr(L tau L^T) - 4/3 tr L tr(L tau) + (2/9 (tr L)^2 + tr(L L)/3) tr tau. The mean t of tau contributes
/// 2 t |dev sym L|^2; the mixed term of its deviator d (Pa) is halved between (tr L)^2 and |L|^2.
template <class T>
TangentBound<T> isochoric_stress_bound(const T& t, const Tensor<T>& d) {
  const T mean = max(t, T(0)), deviation = sqrt(double_dot(d, d));
  return {.volumetric = T(2.0 / 3.0) * (deviation - mean),
          .gradient = T(2) * mean + T(std::sqrt(2.0 / 3.0) + 2.0 / 3.0) * deviation};
}

/// The bound of `curvature` |dev L|^2, |dev L|^2 = |L|^2 - (tr L)^2 / 3.
template <class T>
TangentBound<T> change_of_shape_bound(const T& curvature) {
  return {.volumetric = T(-1.0 / 3.0) * curvature, .gradient = curvature};
}

/// The bound of a law whose volumetric part is replaced by one of slope p and curvature `bulk` (Pa), as in
/// elements that average it. A law that is not the sum of an isochoric and a volumetric part has a bound of
/// the total, to which the difference is added.
template <class Law, class T>
TangentBound<T> tangent_bound(const Law& law, const Tensor<T>& H, const T& J_minus_one, const T& p,
                              const T& bulk) {
  const T J = T(1) + J_minus_one;
  if constexpr (requires { law.tangent_bound(H, J_minus_one, p, bulk); }) {
    return law.tangent_bound(H, J_minus_one, p, bulk);
  } else if constexpr (requires { law.tangent_bound(H); }) {
    return law.tangent_bound(H) +
           volumetric_tangent_bound(J, p - law.pressure(J_minus_one), bulk - law.bulk_tangent(J_minus_one));
  } else {
    return law.isochoric_tangent_bound(H) + volumetric_tangent_bound(J, p, bulk);
  }
}

/// The bound of a whole law at the displacement gradient H.
template <class Law, class T>
TangentBound<T> tangent_bound(const Law& law, const Tensor<T>& H) {
  const T J_minus_one = jacobian_minus_one(H);
  return tangent_bound(law, H, J_minus_one, law.pressure(J_minus_one), law.bulk_tangent(J_minus_one));
}

/// The bound of a law whose isochoric stress has relaxed to an unknown share. If a law has only a bound of
/// the total, the response is between the total and its volumetric part, which is stiffer if the isochoric
/// part softens.
template <class Law, class T>
TangentBound<T> viscoelastic_tangent_bound(const Law& law, const Tensor<T>& H, const T& J_minus_one,
                                           const T& p, const T& bulk) {
  if constexpr (requires { law.viscoelastic_tangent_bound(H, J_minus_one, p, bulk); }) {
    return law.viscoelastic_tangent_bound(H, J_minus_one, p, bulk);
  } else if constexpr (requires { law.tangent_bound(H); }) {
    const T J = T(1) + J_minus_one;
    const T own_p = law.pressure(J_minus_one), own_bulk = law.bulk_tangent(J_minus_one);
    const TangentBound<T> whole = law.tangent_bound(H);
    const TangentBound<T> volume = volumetric_tangent_bound(J, own_p, own_bulk);
    return TangentBound<T>{max(whole.volumetric, volume.volumetric), max(whole.gradient, volume.gradient)} +
           volumetric_tangent_bound(J, p - own_p, bulk - own_bulk);
  } else {
    return tangent_bound(law, H, J_minus_one, p, bulk);
  }
}

/// volumetric |g|^2 + gradient lambda_max(g^T g) for shape gradients g (1/m): an upper bound of the largest
/// eigenvalue per volume (Pa/m^2), since (tr L)^2 <= |g|^2 |v|^2 and |L|^2 <= lambda_max |v|^2 for L = v^T g.
template <class T, int nodes>
T gradient_bound(const TangentBound<T>& bound, const Matrix<T, nodes, 3>& g) {
  const Tensor<T> G = transpose(g) * g;
  return max(bound.volumetric, T(0)) * trace(G) + bound.gradient * largest_eigenvalue_bound(G);
}

}  // namespace sandglass
