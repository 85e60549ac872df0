#pragma once

#include "math/matrix.hpp"

/// The modal form of nodal values. Trilinear shape functions are spanned by one translation, three linear and
/// four hourglass modes whose nodal values are all +1 or -1, so that going there and back takes additions
/// only.
namespace sandglass {

/// Amplitudes of the seven modes that deform an element, each with three components: rows 0 to 2 belong to
/// xi, eta, zeta, rows 3 to 6 to the hourglass modes eta zeta, xi zeta, xi eta, xi eta zeta. They are sums
/// over the nodes.
template <class T>
using Modes = Matrix<T, 7, 3>;

/// sum_I s_mI u_I for each mode m, s its nodal signs: a butterfly of 23 additions per component.
template <class T>
constexpr Modes<T> to_modes(const NodalVectors<T>& u) {
  Modes<T> modes;
  for (int i = 0; i < 3; ++i) {
    // Pairs along xi, in the order (eta, zeta) = (-, -), (+, -), (-, +), (+, +).
    const T s0 = u(0, i) + u(1, i), d0 = u(1, i) - u(0, i);
    const T s1 = u(3, i) + u(2, i), d1 = u(2, i) - u(3, i);
    const T s2 = u(4, i) + u(5, i), d2 = u(5, i) - u(4, i);
    const T s3 = u(7, i) + u(6, i), d3 = u(6, i) - u(7, i);
    // Along eta.
    const T ss0 = s0 + s1, ss1 = s2 + s3;
    const T sd0 = s1 - s0, sd1 = s3 - s2;
    const T ds0 = d0 + d1, ds1 = d2 + d3;
    const T dd0 = d1 - d0, dd1 = d3 - d2;
    // Along zeta.
    modes(0, i) = ds0 + ds1;
    modes(1, i) = sd0 + sd1;
    modes(2, i) = ss1 - ss0;
    modes(3, i) = sd1 - sd0;
    modes(4, i) = ds1 - ds0;
    modes(5, i) = dd0 + dd1;
    modes(6, i) = dd1 - dd0;
  }
  return modes;
}

/// sum_m s_mI a_m at each node I: the transpose of `to_modes`, 20 additions per component.
template <class T>
constexpr NodalVectors<T> from_modes(const Modes<T>& a) {
  NodalVectors<T> f;
  for (int i = 0; i < 3; ++i) {
    const T sd0 = a(1, i) - a(3, i), sd1 = a(1, i) + a(3, i);
    const T ds0 = a(0, i) - a(4, i), ds1 = a(0, i) + a(4, i);
    const T dd0 = a(5, i) - a(6, i), dd1 = a(5, i) + a(6, i);
    const T s0 = -a(2, i) - sd0, s1 = sd0 - a(2, i);
    const T s2 = a(2, i) - sd1, s3 = a(2, i) + sd1;
    const T d0 = ds0 - dd0, d1 = ds0 + dd0;
    const T d2 = ds1 - dd1, d3 = ds1 + dd1;
    f(0, i) = s0 - d0;
    f(1, i) = s0 + d0;
    f(3, i) = s1 - d1;
    f(2, i) = s1 + d1;
    f(4, i) = s2 - d2;
    f(5, i) = s2 + d2;
    f(7, i) = s3 - d3;
    f(6, i) = s3 + d3;
  }
  return f;
}

}  // namespace sandglass
