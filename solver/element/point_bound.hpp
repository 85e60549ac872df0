#pragma once

#include <array>

#include "material/memory.hpp"
#include "material/tangent_bound.hpp"
#include "math/strain.hpp"
#include "mesh/hexahedron.hpp"

namespace sandglass {

/// An upper bound (N/m) of the tangent of an element with N integration points of reference volume `weight`
/// (m^3) and displacement gradient H: the sum of the bounds of its points. gradient_at(q) gives the spatial
/// gradients (1/m) at point q; the pressure follows from `dilatation`. With `shared`, one pressure for the
/// element of volume V (m^3), the bulk stiffness acts on the mean spatial gradient only.
template <bool shared, class T, std::size_t N, class GradientAt, class Law>
T point_bound(const std::array<Tensor<T>, N>& H, const std::array<T, N>& dilatation,
              const std::array<T, N>& weight, const T& V, const GradientAt& gradient_at, const Law& law) {
  T bound = T(0);
  NodalVectors<T> mean_spatial_gradient{};
  for (std::size_t q = 0; q < N; ++q) {
    const NodalVectors<T> g = gradient_at(q);
    const T J_minus_one = jacobian_minus_one(H[q]);
    const T bulk = shared ? T(0) : law.bulk_tangent(dilatation[q]);
    const auto point = tangent_bound(at_point(law, q), H[q], J_minus_one, law.pressure(dilatation[q]), bulk);
    bound = bound + weight[q] * gradient_bound(point, g);
    mean_spatial_gradient += (weight[q] * (T(1) + J_minus_one) / V) * g;
  }
  if constexpr (shared) {
    bound = bound +
            V * law.bulk_tangent(dilatation[0]) * double_dot(mean_spatial_gradient, mean_spatial_gradient);
  }
  return bound;
}

}  // namespace sandglass
