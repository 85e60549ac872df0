#pragma once

#include <string_view>

#include "base/type_list.hpp"
#include "math/exponential.hpp"

/// Volumetric energies K u(J) that a material may have in place of its law's K/2 (J - 1)^2. Each has u and
/// its first two derivatives as functions of x = J - 1; all have u'' = 1 at x = 0.
namespace sandglass {

/// u = (J - 1)^2 / 2.
struct QuadraticPart {
  static constexpr std::string_view name = "quadratic";
  template <class T>
  static T energy(const T& x) {
    return T(0.5) * x * x;
  }
  template <class T>
  static T slope(const T& x) {
    return x;
  }
  template <class T>
  static T curvature(const T& /*x*/) {
    return T(1);
  }
};

/// u = (ln J)^2 / 2, which no finite pressure compresses to zero volume; convex for J < e.
struct LogarithmicPart {
  static constexpr std::string_view name = "logarithmic";
  template <class T>
  static T energy(const T& x) {
    const T l = log1p(x);
    return T(0.5) * l * l;
  }
  template <class T>
  static T slope(const T& x) {
    return log1p(x) / (T(1) + x);
  }
  template <class T>
  static T curvature(const T& x) {
    const T J = T(1) + x;
    return (T(1) - log1p(x)) / (J * J);
  }
};

/// u = (J^2 - 1 - 2 ln J) / 4 (Ciarlet 1988, Simo and Taylor 1991), convex everywhere.
struct QuadraticLogarithmicPart {
  static constexpr std::string_view name = "quadratic-logarithmic";
  template <class T>
  static T energy(const T& x) {  // x - ln J = e^l - 1 - l, l = ln J, by a series where it cancels
    const T l = log1p(x);
    return T(0.25) * (x * x + l * l * relative_exponential_remainder(l));
  }
  template <class T>
  static T slope(const T& x) {  // (J - 1/J) / 2
    return T(0.5) * x * (T(2) + x) / (T(1) + x);
  }
  template <class T>
  static T curvature(const T& x) {
    const T J = T(1) + x;
    return T(0.5) + T(0.5) / (J * J);
  }
};

/// The list of volumetric parts; the first is that of the laws themselves.
using VolumetricParts = TypeList<QuadraticPart, LogarithmicPart, QuadraticLogarithmicPart>;
using VolumetricPart = VariantOf<VolumetricParts>;

}  // namespace sandglass
