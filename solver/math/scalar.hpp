#pragma once

#include <algorithm>
#include <bit>
#include <cmath>
#include <concepts>
#include <cstdint>

/// The vocabulary of scalar functions that kernels may use. A number type (double, float, a pack, a counter,
/// a dual number) joins by giving these overloads in this namespace; kernels then need no change. There is no
/// `if` on a value in a kernel: `select` and `any` take its place, because a pack cannot branch. expm1 and
/// log1p belong to it too; they are in exponential.hpp.
namespace sandglass {

// clang-format off
template <std::floating_point T> T sqrt(T x) { return std::sqrt(x); }
template <std::floating_point T> T abs(T x) { return std::abs(x); }
template <std::floating_point T> T max(T a, T b) { return std::max(a, b); }
template <std::floating_point T> T min(T a, T b) { return std::min(a, b); }
// clang-format on

/// x^(-1/3) from a guess y within 3.4 %: two steps of fourth order from r = 1 - x y^3, y (1 - r)^(-1/3)
/// expanded. The second ends at a few units in the last place; tested against cbrt.
template <class T>
T refined_inverse_cube_root(const T& x, T y) {
  for (int step = 0; step < 2; ++step) {
    const T r = T(1) - x * (y * y * y);
    y = y + y * (r * (T(1.0 / 3.0) + r * (T(2.0 / 9.0) + r * T(14.0 / 81.0))));
  }
  return y;
}

/// The bits of a float, read as an integer, are a scaled and shifted logarithm: times this and plus that they
/// are the bits of x^(-1/3), within 3.4 %.
inline constexpr float cube_root_slope = -1.0F / 3.0F;
inline constexpr float cube_root_shift = 1.4199153e9F;

/// x^(-1/3) for x > 0: the one root that isochoric laws need, J^(-2/3) being its square. Without a general
/// power or a division, and operation by operation the same as for packs.
template <std::floating_point T>
T inverse_cube_root(T x) {
  const auto bits = static_cast<float>(std::bit_cast<std::int32_t>(static_cast<float>(x)));
  const auto root_bits = static_cast<std::int32_t>(bits * cube_root_slope + cube_root_shift);
  return refined_inverse_cube_root(x, static_cast<T>(std::bit_cast<float>(root_bits)));
}

/// `a` where the mask is true, `b` elsewhere.
template <std::floating_point T>
T select(bool mask, T a, T b) {
  return mask ? a : b;
}

}  // namespace sandglass
