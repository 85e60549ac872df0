#pragma once

#include <algorithm>
#include <bit>
#include <cmath>
#include <concepts>
#include <cstdint>

/// The scalar functions that kernels may use. A number type (double, float, a pack, a counter, a dual number)
/// provides overloads of them in this namespace; kernels then need no change. Kernels contain no `if` on a
/// value but `select`, because a pack cannot branch. expm1 and log1p belong to the set, too; they are in
/// exponential.hpp.
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

/// The bits of a float x, read as an integer, are a scaled and shifted logarithm: this slope and shift turn
/// them into the bits of x^(-1/3), within 3.4 %.
inline constexpr float cube_root_slope = -1.0F / 3.0F;
inline constexpr float cube_root_shift = 1.4199153e9F;

/// x^(-1/3) for x > 0: the only root that isochoric laws need, J^(-2/3) being its square. It takes neither a
/// general power nor a division, and the same operations as for packs.
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
