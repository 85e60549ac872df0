#pragma once

#include <string_view>

#include "base/type_list.hpp"
#include "math/dual.hpp"
#include "math/matrix.hpp"

/// Displacement fields of finite strain with known derivatives: u(X) in m on a unit cube, for any number
/// type, times `amplitude`, which is below one for laws that bear less.
namespace sandglass::verification {

inline double sine(double x) {
  return std::sin(x);
}
inline double cosine(double x) {
  return std::cos(x);
}
template <class T>
Dual<T> cosine(const Dual<T>& x);
template <class T>
Dual<T> sine(const Dual<T>& x) {
  return {sine(x.value), cosine(x.value) * x.slope};
}
template <class T>
Dual<T> cosine(const Dual<T>& x) {
  return {cosine(x.value), -(sine(x.value) * x.slope)};
}

/// Three waves, u = sum_m a_m sin(k_m . X + phase_m). They are almost transverse: displacement gradients
/// reach a Frobenius norm of 0.33 while det F stays between 0.955 and 1.040, so that nearly incompressible
/// laws bear it too. No part is symmetric or polynomial.
struct WaveField {
  static constexpr std::string_view name = "waves";
  double amplitude = 1.0;

  template <class T>
  Triple<T> operator()(const Triple<T>& X) const {
    constexpr Tensor<double> k{{2.1, 1.2, -0.9, -1.1, 1.8, 1.3, 1.4, -0.8, 2.0}};  // 1/m, one wave per row
    constexpr Tensor<double> a{{0.03, -0.015, 0.06, 0.06, -0.01, 0.06, 0.03, 0.06, 0.0}};  // m
    constexpr std::array<double, 3> phase{0.3, 1.1, -0.4};
    Triple<T> u = from_double<T>(Triple<double>{});
    for (int m = 0; m < 3; ++m) {
      const T angle = T(k(m, 0)) * X(0, 0) + T(k(m, 1)) * X(1, 0) + T(k(m, 2)) * X(2, 0);
      const T wave = sine(angle + T(phase[static_cast<std::size_t>(m)]));
      for (int i = 0; i < 3; ++i) u(i, 0) = u(i, 0) + T(amplitude * a(m, i)) * wave;
    }
    return u;
  }
};

/// The cube bent into a part of a ring of 2 m mean radius (Rivlin's flexure): planes across x become planes
/// through its axis, those across z become cylinders with r^2 = a^2 + 2 a z, so that det F = 1.
struct FlexureField {
  static constexpr std::string_view name = "flexure";
  double amplitude = 1.0;

  template <class T>
  Triple<T> operator()(const Triple<T>& X) const {
    const T x = X(0, 0) - T(0.5), z = X(2, 0) - T(0.5), a = T(2.0 / amplitude);
    const T r = sqrt(a * a + T(2) * a * z), angle = x / a;
    return {{r * sine(angle) - x, T(0), r * cosine(angle) - a - z}};
  }
};

/// manufactured_test.cpp tests every method with each of them.
using ExactFields = TypeList<WaveField, FlexureField>;

}  // namespace sandglass::verification
