#pragma once

#include <array>
#include <bit>
#include <concepts>
#include <cstdint>
#include <limits>

#include "math/scalar.hpp"

/// expm1 and log1p for kernels: the same operations on plain numbers and on packs, without branches or
/// tables. Accurate to two units in the last place wherever argument and result are normal numbers.
namespace sandglass {

/// 2^n for a whole number n within the range of exponents: n is shifted into the exponent's bits.
template <std::floating_point Real>
Real power_of_two(Real n) {
  using Bits = detail::FloatBits<Real>;
  const auto bits =
      std::bit_cast<typename Bits::Integer>(n + (Real(1.5) * Bits::integers + Real(Bits::bias)));
  return std::bit_cast<Real>(bits << Bits::mantissa);
}

/// The whole number n with 2^n <= x < 2^(n + 1), for normal x > 0.
template <std::floating_point Real>
Real binary_exponent(Real x) {
  using Bits = detail::FloatBits<Real>;
  const auto bits = std::bit_cast<typename Bits::Integer>(x) >> Bits::mantissa;
  const auto shifted = bits | std::bit_cast<typename Bits::Integer>(Bits::integers);
  return std::bit_cast<Real>(shifted) - (Bits::integers + Real(Bits::bias));
}

namespace detail {

/// c[0] + c[1] x + c[2] x^2 + ...
template <class T, std::size_t N>
constexpr T polynomial(const T& x, const std::array<double, N>& c) {
  T sum = T(c[N - 1]);
  for (std::size_t n = N - 1; n-- > 0;) sum = sum * x + T(c[n]);
  return sum;
}

/// 1/2!, 1/3!, ...: (e^r - 1 - r) / r^2.
template <std::size_t N>
constexpr std::array<double, N> inverse_factorials() {
  std::array<double, N> c{};
  double factorial = 1.0;
  for (std::size_t n = 0; n < N; ++n) {
    factorial *= static_cast<double>(n + 2);
    c[n] = 1.0 / factorial;
  }
  return c;
}

/// 2/3, 2/5, ...: (log((1 + s) / (1 - s)) - 2 s) / s^3 in s^2.
template <std::size_t N>
constexpr std::array<double, N> odd_fractions() {
  std::array<double, N> c{};
  for (std::size_t n = 0; n < N; ++n) c[n] = 2.0 / static_cast<double>(2 * n + 3);
  return c;
}

/// e^x - 1 = 2^n (e^r - 1) + (2^n - 1) with x = n ln 2 + r, |r| <= ln(2)/2, and Taylor's series in r. With
/// n = 0 nothing is added, and small x keep their digits. Half the result is computed first, because 2^1024
/// overflows.
template <class Real, class T>
T exponential_minus_one(T x) {
  using Bits = FloatBits<Real>;
  x = select(x < T(-64), T(-64), x);  // -1 to the last bit
  x = select(x > T(Bits::largest_logarithm), T(Bits::largest_logarithm), x);
  const T rounder(Real(1.5) * Bits::integers);
  const T n = (x * T(1.4426950408889634) + rounder) - rounder;
  const T r = (x - n * T(Bits::ln2_high)) - n * T(Bits::ln2_low);
  const T series = r + r * r * polynomial(r, inverse_factorials<Bits::exponential_terms - 1>());
  const T half = power_of_two(n - T(1));
  return T(2) * (half * series + (half - T(0.5)));
}

/// log(1 + x) = k ln 2 + log f with 1 + x = 2^k f, f in [1/sqrt 2, sqrt 2], and log f = 2 s + 2/3 s^3 + ...,
/// s = (f - 1)/(f + 1), where 2 s = (f - 1) - s (f - 1) needs no rounding of its leading term. f - 1 = 2^-k x
/// + (2^-k - 1) is rounded only once, and with k = 0 not at all: small x keep their digits. A factor of four
/// is applied separately, because 2^-1024 underflows.
template <class Real, class T>
T logarithm_of_one_plus(const T& x) {
  using Bits = FloatBits<Real>;
  const T one_plus = T(1) + x;
  const T k = binary_exponent(one_plus * T(0.70710678118654752)) + T(1);
  const T scale = power_of_two(T(2) - k);
  const T f_minus_one = T(0.25) * (x * scale) + (T(0.25) * scale - T(1));
  const T s = f_minus_one / (T(2) + f_minus_one);
  const T s2 = s * s;
  const T rest = s * (f_minus_one - s2 * polynomial(s2, odd_fractions<Bits::logarithm_terms - 1>()));
  const T inside = k * T(Bits::ln2_high) + (f_minus_one - (rest - k * T(Bits::ln2_low)));
  // Outside (0, infinity) as std::log1p: -infinity at zero, NaN below, infinity at infinity.
  constexpr Real infinity = std::numeric_limits<Real>::infinity();
  const T outside = select(one_plus < T(0), T(std::numeric_limits<Real>::quiet_NaN()),
                           select(one_plus > T(0), one_plus, T(-infinity) + one_plus));
  return select(one_plus > T(0), select(one_plus < T(infinity), inside, outside), outside);
}

}  // namespace detail

/// e^x - 1 without cancellation near zero.
template <std::floating_point Real>
Real expm1(Real x) {
  return detail::exponential_minus_one<Real>(x);
}

/// log(1 + x) without cancellation near zero.
template <std::floating_point Real>
Real log1p(Real x) {
  return detail::logarithm_of_one_plus<Real>(x);
}

/// (e^x - 1)/x, 1 at zero. Its dual slope has an error of eps/x, which a product with x removes.
template <class T>
T relative_expm1(const T& x) {
  const auto tiny = abs(x) < T(1e-30);
  return select(tiny, T(1), expm1(x) / select(tiny, T(1), x));
}

/// log(1 + x)/x, 1 at zero.
template <class T>
T relative_log1p(const T& x) {
  const auto tiny = abs(x) < T(1e-30);
  return select(tiny, T(1), log1p(x) / select(tiny, T(1), x));
}

/// 2 (e^x - 1 - x)/x^2, 1 at zero: by its series where the difference would cancel.
template <class T>
T relative_exponential_remainder(const T& x) {
  const auto near = abs(x) < T(1);
  const T small = select(near, x, T(0)), large = select(near, T(1), x);
  const T series = T(2) * detail::polynomial(small, detail::inverse_factorials<16>());
  return select(near, series, T(2) * (expm1(large) - large) / (large * large));
}

}  // namespace sandglass
