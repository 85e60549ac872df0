#pragma once

#include <array>
#include <set>

#include "mesh/hexahedron.hpp"

namespace sandglass::verification {

/// The 24 rotations of the cube as node permutations: closure of two quarter turns.
inline std::set<std::array<int, 8>> proper_orderings() {
  using Ordering = std::array<int, 8>;
  constexpr Ordering about_z{1, 2, 3, 0, 5, 6, 7, 4};
  constexpr Ordering about_x{3, 2, 6, 7, 0, 1, 5, 4};
  const auto after = [](const Ordering& first, const Ordering& second) {
    Ordering result{};
    for (std::size_t I = 0; I < 8; ++I) result[I] = first[static_cast<std::size_t>(second[I])];
    return result;
  };
  std::set<Ordering> all{{0, 1, 2, 3, 4, 5, 6, 7}};
  for (std::size_t before = 0; before != all.size();) {
    before = all.size();
    const auto known = all;
    for (const auto& ordering : known) {
      all.insert(after(ordering, about_z));
      all.insert(after(ordering, about_x));
    }
  }
  return all;
}

inline NodalVectors<double> reordered(const NodalVectors<double>& rows, const std::array<int, 8>& ordering) {
  NodalVectors<double> result{};
  for (int I = 0; I < 8; ++I) {
    for (int i = 0; i < 3; ++i) result(I, i) = rows(ordering[static_cast<std::size_t>(I)], i);
  }
  return result;
}

}  // namespace sandglass::verification
