#pragma once

#include <algorithm>
#include <cmath>
#include <concepts>

/// The vocabulary of scalar functions that kernels may use. A number type (double, float, a pack, a counter,
/// a dual number) joins by giving these overloads in this namespace; kernels then need no change. There is no
/// `if` on a value in a kernel: `select` and `any` take its place, because a pack cannot branch.
namespace sandglass {

// clang-format off
template <std::floating_point T> T sqrt(T x) { return std::sqrt(x); }
template <std::floating_point T> T abs(T x) { return std::abs(x); }
template <std::floating_point T> T max(T a, T b) { return std::max(a, b); }
template <std::floating_point T> T min(T a, T b) { return std::min(a, b); }
template <std::floating_point T> T log1p(T x) { return std::log1p(x); }
template <std::floating_point T> T expm1(T x) { return std::expm1(x); }
// clang-format on

/// x^(-1/3): the one root that isochoric laws need, J^(-2/3) being its square.
template <std::floating_point T>
T inverse_cube_root(T x) {
  return T(1) / std::cbrt(x);
}

/// `a` where the mask is true, `b` elsewhere.
template <std::floating_point T>
T select(bool mask, T a, T b) {
  return mask ? a : b;
}

/// Whether the mask is true anywhere.
inline bool any(bool mask) {
  return mask;
}

}  // namespace sandglass
