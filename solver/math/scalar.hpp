#pragma once

#include <algorithm>
#include <bit>
#include <cmath>
#include <concepts>
#include <cstdint>

/// The scalar functions that kernels may use. A number type (double, float, a pack, a counter, a dual number)
/// provides overloads of them in this namespace; kernels then need no change. Kernels use `select` instead of
/// `if` on a value, because a pack cannot branch. expm1 and log1p also belong to the set; they are in
/// exponential.hpp.
namespace sandglass {

// clang-format off
template <std::floating_point T> T sqrt(T x) { return std::sqrt(x); }
template <std::floating_point T> T abs(T x) { return std::abs(x); }
template <std::floating_point T> T max(T a, T b) { return std::max(a, b); }
template <std::floating_point T> T min(T a, T b) { return std::min(a, b); }
template <std::floating_point T> bool is_zero(T x) { return x == T(0); }
// clang-format on

namespace detail {

/// The layout of a floating-point number in its bits.
template <class Real>
struct FloatBits;
template <>
struct FloatBits<double> {
  using Integer = std::int64_t;
  static constexpr int mantissa = 52;
  static constexpr int bias = 1023;
  static constexpr double integers = 0x1p52;           ///< from here, neighbouring numbers differ by one
  static constexpr double ln2_high = 0x1.62e42feep-1;  ///< few digits: its products with exponents are exact
  static constexpr double ln2_low = 0x1.a39ef35793c76p-33;
  static constexpr double largest_logarithm = 710.0;  ///< exp of it overflows
  static constexpr int exponential_terms = 13;        ///< the next would be 1e-17 of the sum
  static constexpr int logarithm_terms = 10;          ///< the next would be 2e-17
};
template <>
struct FloatBits<float> {
  using Integer = std::int32_t;
  static constexpr int mantissa = 23;
  static constexpr int bias = 127;
  static constexpr float integers = 0x1p23F;
  static constexpr float ln2_high = 0x1.62e3p-1F;
  static constexpr float ln2_low = 0x1.2fefa2p-17F;
  static constexpr float largest_logarithm = 89.0F;
  static constexpr int exponential_terms = 8;  ///< the next would be 6e-10 of the sum
  static constexpr int logarithm_terms = 5;    ///< the next would be 2e-9
};

}  // namespace detail

/// The guess of x^(-1/3): the bits of a number x > 0, read as an integer, are a scaled and shifted logarithm
/// of x. A linear map gives those of x^(-1/3), within 3.4 %. The computation treats the integer as a
/// floating-point number from `integers` on, whose last bits hold it; the integer's own last `shift` bits are
/// dropped to make it fit.
template <class T>
struct RootGuess {
  using Bits = detail::FloatBits<T>;
  static constexpr int shift = 8 * static_cast<int>(sizeof(T)) - Bits::mantissa;
  static constexpr auto integers = std::bit_cast<typename Bits::Integer>(Bits::integers);
  static constexpr T slope = T(-1.0 / 3.0);
  static constexpr T start = T(4.0 / 3.0) * Bits::integers + Bits::integers /
                                                                 T(typename Bits::Integer{1} << shift) *
                                                                 (T(4.0 / 3.0) * T(Bits::bias) - T(0.06623));
};

/// x^(-1/3) from a guess y: two steps of fourth order from r = 1 - x y^3, y (1 - r)^(-1/3) expanded, each
/// with as few operations in a row as possible. The second ends at a few units in the last place; tested
/// against cbrt.
template <class T>
T refined_inverse_cube_root(const T& x, T y) {
  for (int step = 0; step < 2; ++step) {
    const T r = T(1) - (x * y) * (y * y);
    y = y + (y * r) * ((T(1.0 / 3.0) + T(2.0 / 9.0) * r) + T(14.0 / 81.0) * (r * r));
  }
  return y;
}

/// x^(-1/3) for x > 0: the only root that isochoric laws need, J^(-2/3) being its square. It takes neither a
/// general power nor a division, and the same operations as for packs.
template <std::floating_point T>
T inverse_cube_root(T x) {
  using Integer = typename detail::FloatBits<T>::Integer;
  using Guess = RootGuess<T>;
  const T logarithm = std::bit_cast<T>((std::bit_cast<Integer>(x) >> Guess::shift) | Guess::integers);
  const T root = Guess::start + Guess::slope * logarithm;
  return refined_inverse_cube_root(x, std::bit_cast<T>(std::bit_cast<Integer>(root) << Guess::shift));
}

/// `a` where the mask is true, `b` elsewhere.
template <std::floating_point T>
T select(bool mask, T a, T b) {
  return mask ? a : b;
}

}  // namespace sandglass
