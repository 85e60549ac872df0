#pragma once

#include <array>
#include <cstddef>

#include "material/memory.hpp"
#include "material/point_load.hpp"

namespace sandglass {

/// Calls use(q, V P) for the integration points q of an element, in order, with the first Piola-Kirchhoff
/// stress times reference volume (Pa m^3) for the displacement gradient H[q] and the PointLoad at(q).
template <class T, std::size_t N, class Law, class LoadAt, class Use>
void for_each_stress(const Law& law, const std::array<Tensor<T>, N>& H, const LoadAt& at, const Use& use) {
  if constexpr (TakesAllPoints<Law, T>) {
    std::array<PointLoad<T>, N> loads;
    for (std::size_t q = 0; q < N; ++q) loads[q] = at(q);
    std::array<Tensor<T>, N> VP;
    law.weighted_piola(N, loads.data(), H.data(), VP.data());
    for (std::size_t q = 0; q < N; ++q) use(q, VP[q]);
  } else {
    for (std::size_t q = 0; q < N; ++q) {
      const PointLoad<T> load = at(q);
      use(q, at_point(law, q).weighted_piola(load.V, H[q], load.change, load.p));
    }
  }
}

}  // namespace sandglass
