#pragma once

#include <array>

#include "math/dual.hpp"
#include "math/exponential.hpp"
#include "math/matrix.hpp"
#include "math/symmetric.hpp"

/// Principal values of symmetric tensors, and isotropic functions of them: without branches, and with exact
/// derivatives also where principal values coincide.
namespace sandglass {

/// A symmetric tensor S = sum_a values[a] n_a (x) n_a; the first value is the one farthest from the others.
template <class T>
struct Spectrum {
  std::array<T, 3> values;
  Symmetric<T> first;       ///< n_0 (x) n_0
  Symmetric<T> difference;  ///< n_1 (x) n_1 - n_2 (x) n_2, nearly zero if both values coincide
};

/// The spectrum of a dual tensor S + epsilon dS, with the n_a of S in the columns of `axes`, in no particular
/// order: where values coincide, axes have no derivative, but isotropic functions do. It follows from the
/// change of the values, n_a . dS n_a, and from the other entries of dS in the frame of S, which rotate the
/// axes.
template <class T>
struct Spectrum<Dual<T>> {
  std::array<Dual<T>, 3> values;
  Tensor<T> axes;
  Tensor<T> turn;  ///< n_a . dS n_b
};

/// The third of the axes 0, 1, 2.
constexpr int third_axis(int a, int b) {
  return 3 - a - b;
}

namespace detail {

/// c = cos(acos(w)/3) for 0 <= w <= 1, the root of 4 c^3 - 3 c = w from sqrt(3)/2 to 1, and 1/(12 c^2 - 3):
/// each by one of Newton's steps from a polynomial that is off by 1.3e-8, which interpolates at Chebyshev's
/// points.
template <class T>
std::array<T, 2> cosine_of_third(const T& w) {
  const T near = polynomial(w, std::array{0.8660254163908419, 0.1666650430632138, -0.04807735034478527,
                                          0.024392383831067718, -0.014289564824979865, 0.0076643017539533296,
                                          -0.002922830501684878, 0.000542607712687352});
  const T square = near * near;
  const T inverse = T(1) / (T(12) * square - T(3));
  const T c = near - inverse * (near * (T(4) * square - T(3)) - w);
  return {c, inverse * (T(2) - inverse * (T(12) * c * c - T(3)))};
}

/// Rotates a symmetric tensor into its principal frame by cyclic Jacobi rotations in four sweeps, which leave
/// 3e-21 of it beside the diagonal. Returns the axes, in columns. The tangent t of an angle is the smaller
/// root of t^2 + (S_qq - S_pp)/S_pq t - 1 = 0 (Golub & Van Loan, Matrix Computations, section 8.5.2).
template <class T>
Tensor<T> diagonalize(Tensor<T>& S) {
  Tensor<T> axes = identity<T>();
  for (int step = 0; step < 12; ++step) {
    const int p = step % 3 == 2 ? 1 : 0, q = step % 3 == 0 ? 1 : 2;
    const T difference = S(q, q) - S(p, p), twice = T(2) * S(p, q);
    const T root = max(sqrt(difference * difference + twice * twice), abs(twice));
    const T sum = (abs(difference) + root) + T(1e-30);
    const T t = twice / select(difference < T(0), -sum, sum);
    Tensor<T> R = identity<T>();
    R(p, p) = R(q, q) = T(1) / sqrt(T(1) + t * t);
    R(p, q) = t * R(p, p);
    R(q, p) = -R(p, q);
    S = transpose(R) * S * R;
    axes = axes * R;
  }
  return axes;
}

/// sum_a t_a n_a (x) n_a.
template <class T>
Tensor<T> from_principal(const Tensor<T>& axes, const std::array<T, 3>& t) {
  Tensor<T> weighted;
  for (int i = 0; i < 3; ++i) {
    for (int a = 0; a < 3; ++a) weighted(i, a) = t[static_cast<std::size_t>(a)] * axes(i, a);
  }
  Tensor<T> S;
  for (int i = 0; i < 3; ++i) {
    for (int j = i; j < 3; ++j) {
      S(i, j) = weighted(i, 0) * axes(j, 0) + weighted(i, 1) * axes(j, 1) + weighted(i, 2) * axes(j, 2);
      S(j, i) = S(i, j);
    }
  }
  return S;
}

}  // namespace detail

/// Without axes, which are lost where values coincide. With the deviator D = p E, E:E = 6, the eigenvalue of
/// E farthest from the others is v = 2 c, with the sign of det E = 2 w and 4 c^3 - 3 c = |w| (Smith, Commun.
/// ACM 4 (1961) 168). E - v I is of rank two, and its adjugate, adj E + v E + v^2 I, is n_0 (x) n_0 times the
/// product of its other two values, 12 c^2 - 3. The rest of E lies in the plane normal to n_0. Errors are of
/// the size of the roundoff of the largest entry.
template <class T>
Spectrum<T> spectrum(const Tensor<T>& S) {
  const auto inverse_root = [](const T& square) { return T(1) / sqrt(select(square > T(0), square, T(1))); };
  const T mean = T(1.0 / 3.0) * trace(S);
  const Symmetric<T> D = six_entries(deviator(S));
  const T square = T(1.0 / 6.0) * norm_square(D);
  const T scale = inverse_root(square), p = square * scale;
  const Symmetric<T> E = scale * D, C = cofactor(E);
  const T w = T(0.5) * (E(0, 0) * C(0, 0) + E(3, 0) * C(3, 0) + E(5, 0) * C(5, 0));
  const auto [c, inverse] = detail::cosine_of_third(min(abs(w), T(1)));
  const T v = select(w < T(0), T(-2) * c, T(2) * c), half_v = T(0.5) * v;
  Spectrum<T> found;
  found.first = inverse * plus_identity(v * v, C + v * E);
  const Symmetric<T> rest = plus_identity(half_v, E) - (T(1.5) * v) * found.first;
  const T rest_square = T(0.5) * norm_square(rest);
  const T rest_scale = inverse_root(rest_square), half = rest_square * rest_scale;
  found.difference = rest_scale * rest;
  found.values = {mean + p * v, mean + p * (half - half_v), mean - p * (half + half_v)};
  return found;
}

/// The same for a dual tensor.
template <class T>
Spectrum<Dual<T>> spectrum(const Tensor<Dual<T>>& S) {
  Tensor<T> value, slope;
  for (std::size_t n = 0; n < 9; ++n) {
    value.entries[n] = S.entries[n].value;
    slope.entries[n] = S.entries[n].slope;
  }
  Spectrum<Dual<T>> found;
  found.axes = detail::diagonalize(value);
  found.turn = transpose(found.axes) * slope * found.axes;
  for (int a = 0; a < 3; ++a) found.values[static_cast<std::size_t>(a)] = {value(a, a), found.turn(a, a)};
  return found;
}

/// The tensor sum_a t_a n_a (x) n_a whose principal values t_a = t_a(values) are an isotropic function of the
/// spectrum's. `secants` maps the values to (t_a - t_b)/(values_a - values_b) for the three pairs of axes,
/// each stored at the third axis; only derivatives need them.
template <class T, class Secants>
Tensor<T> isotropic_tensor(const Spectrum<T>& at, const std::array<T, 3>& t, const Secants& /*secants*/) {
  const T mean = T(0.5) * (t[1] + t[2]);
  return full(plus_identity(mean, (t[0] - mean) * at.first + (T(0.5) * (t[1] - t[2])) * at.difference));
}

/// The same with its derivative by the formula of Daleckii and Krein: in the principal frame its entries are
/// the change of t_a on the diagonal, and secant times dS_ab elsewhere (Higham, Functions of Matrices,
/// theorem 3.11).
template <class T, class Secants>
Tensor<Dual<T>> isotropic_tensor(const Spectrum<Dual<T>>& at, const std::array<Dual<T>, 3>& t,
                                 const Secants& secants) {
  const std::array<T, 3> values{at.values[0].value, at.values[1].value, at.values[2].value};
  const std::array<T, 3> secant = secants(values);
  Tensor<T> change;
  for (int a = 0; a < 3; ++a) {
    for (int b = 0; b < 3; ++b) {
      change(a, b) = a == b ? t[static_cast<std::size_t>(a)].slope
                            : secant[static_cast<std::size_t>(third_axis(a, b))] * at.turn(a, b);
    }
  }
  const Tensor<T> value = detail::from_principal(at.axes, {t[0].value, t[1].value, t[2].value});
  const Tensor<T> slope = at.axes * change * transpose(at.axes);
  Tensor<Dual<T>> result;
  for (std::size_t n = 0; n < 9; ++n) result.entries[n] = {value.entries[n], slope.entries[n]};
  return result;
}

}  // namespace sandglass
