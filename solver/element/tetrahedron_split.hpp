#pragma once

#include <array>

#include "mesh/hexahedron.hpp"

/// Both cuts of a hexahedron into five tetrahedra.
namespace sandglass {

/// The tetrahedra of a hexahedron: number I < 8 joins corner I to its three neighbours, numbers 8 and 9 join
/// the corners with xi eta zeta = -1 and +1. Number 8 and those at the corners that are not its own form one
/// cut, number 9 and the others the second.
inline constexpr std::size_t tetrahedron_count = 10;

/// One number, one tensor for each.
template <class T>
using TetrahedronValues = std::array<T, tetrahedron_count>;
template <class T>
using TetrahedronTensors = std::array<Tensor<T>, tetrahedron_count>;

/// Their constants.
template <class T>
struct TetrahedronConstants {
  TetrahedronTensors<T> inverse_jacobian;  ///< dxi_k/dX_j, 1/m, times 1/8 because modes are sums
  TetrahedronValues<T> weight;             ///< half of each volume, m^3
};

namespace detail {

/// Whether node J belongs to tetrahedron e.
constexpr bool belongs(int J, std::size_t e) {
  if (e >= 8) return corner_signs(J, 0) * corner_signs(J, 1) * corner_signs(J, 2) == (e == 8 ? -1.0 : 1.0);
  int steps = 0;
  for (int i = 0; i < 3; ++i) steps += corner_signs(J, i) != corner_signs(static_cast<int>(e), i) ? 1 : 0;
  return steps <= 1;
}

using TetrahedronNodes = std::array<std::array<std::size_t, 4>, tetrahedron_count>;
constexpr TetrahedronNodes tetrahedron_nodes() {
  TetrahedronNodes nodes{};
  for (std::size_t e = 0; e < tetrahedron_count; ++e) {
    std::size_t found = 0;
    for (int J = 0; J < 8; ++J) {
      if (belongs(J, e)) nodes[e][found++] = static_cast<std::size_t>(J);
    }
  }
  return nodes;
}

/// The nodes of each tetrahedron.
inline constexpr TetrahedronNodes nodes_of_tetrahedron = tetrahedron_nodes();

/// Parent gradients of a tetrahedron's linear shape functions, zero at nodes that are not its own.
constexpr NodalVectors<double> tetrahedron_gradient(std::size_t e) {
  if (e < 8) {  // at a corner the trilinear functions have the gradients of the linear ones
    const auto corner = static_cast<int>(e);
    return parent_gradient({corner_signs(corner, 0), corner_signs(corner, 1), corner_signs(corner, 2)});
  }
  NodalVectors<double> gradient{};
  for (const std::size_t J : nodes_of_tetrahedron[e]) {
    for (int i = 0; i < 3; ++i) {
      gradient(static_cast<int>(J), i) = 0.25 * corner_signs(static_cast<int>(J), i);
    }
  }
  return gradient;
}

}  // namespace detail

/// For each tetrahedron the sum over its nodes.
template <class T>
TetrahedronValues<T> sums_over_nodes(const std::array<T, 8>& nodal) {
  TetrahedronValues<T> sums;
  for (std::size_t e = 0; e < tetrahedron_count; ++e) {
    const auto& [a, b, c, d] = detail::nodes_of_tetrahedron[e];
    sums[e] = (nodal[a] + nodal[b]) + (nodal[c] + nodal[d]);
  }
  return sums;
}

/// For each node the sum over the five tetrahedra around it: the transpose of `sums_over_nodes`.
template <class T>
std::array<T, 8> sums_over_tetrahedra(const TetrahedronValues<T>& values) {
  std::array<T, 8> sums;
  for (std::size_t I = 0; I < 8; ++I) {
    sums[I] = values[detail::belongs(static_cast<int>(I), 8) ? 8 : 9];
    // A corner belongs to its neighbours' tetrahedra as they belong to its own.
    for (const std::size_t e : detail::nodes_of_tetrahedron[I]) sums[I] = sums[I] + values[e];
  }
  return sums;
}

/// For each node a quarter of the sum over the tetrahedra around it.
template <class T>
std::array<T, 8> nodal_shares(const TetrahedronValues<T>& values) {
  std::array<T, 8> shares = sums_over_tetrahedra(values);
  for (T& share : shares) share = T(0.25) * share;
  return shares;
}

}  // namespace sandglass
