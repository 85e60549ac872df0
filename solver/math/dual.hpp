#pragma once

#include "math/exponential.hpp"

namespace sandglass {

/// A dual number value + slope * epsilon with epsilon^2 = 0: run a kernel on it and the slope is the exact
/// derivative. It nests: Dual<Dual<double>> gives second derivatives.
template <class T>
struct Dual {
  T value{};
  T slope{};

  constexpr Dual() = default;
  explicit(false) constexpr Dual(double constant) : value(constant) {}
  constexpr Dual(T v, T s) : value(v), slope(s) {}

  friend constexpr Dual operator+(const Dual& a, const Dual& b) {
    return {a.value + b.value, a.slope + b.slope};
  }
  friend constexpr Dual operator-(const Dual& a, const Dual& b) {
    return {a.value - b.value, a.slope - b.slope};
  }
  friend constexpr Dual operator-(const Dual& a) { return {T(0) - a.value, T(0) - a.slope}; }
  friend constexpr Dual operator*(const Dual& a, const Dual& b) {
    return {a.value * b.value, a.value * b.slope + a.slope * b.value};
  }
  friend constexpr Dual operator/(const Dual& a, const Dual& b) {
    const T quotient = a.value / b.value;
    return {quotient, (a.slope - quotient * b.slope) / b.value};
  }
  friend constexpr auto operator<(const Dual& a, const Dual& b) { return a.value < b.value; }
  friend constexpr auto operator>(const Dual& a, const Dual& b) { return a.value > b.value; }

  friend Dual sqrt(const Dual& a) {
    const T root = sqrt(a.value);
    return {root, a.slope / (T(2) * root)};
  }
  friend Dual inverse_cube_root(const Dual& a) {
    const T root = inverse_cube_root(a.value);
    return {root, T(-1.0 / 3.0) * (root / a.value) * a.slope};
  }
  friend Dual log1p(const Dual& a) { return {log1p(a.value), a.slope / (T(1) + a.value)}; }
  friend Dual expm1(const Dual& a) {
    const T e = expm1(a.value);
    return {e, (e + T(1)) * a.slope};
  }
  template <class Mask>
  friend Dual select(const Mask& mask, const Dual& a, const Dual& b) {
    return {select(mask, a.value, b.value), select(mask, a.slope, b.slope)};
  }
  friend Dual abs(const Dual& a) { return select(a.value < T(0), -a, a); }
  friend Dual max(const Dual& a, const Dual& b) { return select(a.value < b.value, b, a); }
  friend Dual min(const Dual& a, const Dual& b) { return select(b.value < a.value, b, a); }
};

}  // namespace sandglass
