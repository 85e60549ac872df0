#pragma once

#include "support/dense_matrix.hpp"
#include "support/derivatives.hpp"

namespace sandglass::verification {

using Tangent = Matrix<double, 24, 24>;

/// The tangent stiffness df/du (N/m) of an element at u, exact, by dual numbers; row and column 3 I + i.
template <class Formulation, class Law>
Tangent tangent_stiffness(const NodalVectors<double>& u,
                          const typename Formulation::template Element<double>& element, const Law& law) {
  const auto dual = dual_element<Formulation>(element);
  Tangent K;
  for (int n = 0; n < 24; ++n) {
    const auto direction = unit<8, 3>(static_cast<std::size_t>(n));
    const auto column = slope(Formulation::force(along(u, direction), dual, law));
    for (int m = 0; m < 24; ++m) K(m, n) = column.entries[static_cast<std::size_t>(m)];
  }
  return K;
}

}  // namespace sandglass::verification
