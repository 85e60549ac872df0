#pragma once

#include "math/matrix.hpp"

namespace sandglass {

/// det(I + H) - 1, expanded so that nothing cancels near the undeformed state.
template <class T>
constexpr T jacobian_minus_one(const Tensor<T>& H) {
  const T second_invariant = (H(0, 0) * H(1, 1) - H(0, 1) * H(1, 0)) +
                             (H(1, 1) * H(2, 2) - H(1, 2) * H(2, 1)) +
                             (H(0, 0) * H(2, 2) - H(0, 2) * H(2, 0));
  return trace(H) + (second_invariant + determinant(H));
}

/// tr E of the Green strain E = (F^T F - I)/2.
template <class T>
constexpr T green_trace(const Tensor<T>& H) {
  return trace(H) + T(0.5) * double_dot(H, H);
}

/// tr E - (J - 1) = H:H/2 - tr(cof H) - det H, of second order in H.
template <class T>
constexpr T excess_dilatation(const Tensor<T>& H, const Tensor<T>& cof_H) {
  const T det_H = H(0, 0) * cof_H(0, 0) + H(0, 1) * cof_H(0, 1) + H(0, 2) * cof_H(0, 2);
  return T(0.5) * double_dot(H, H) - (trace(cof_H) + det_H);
}

/// The volume change at a point: J - 1, and J^(-1/3), by which isochoric laws scale F. The root is a long
/// chain of dependent operations; if computed early, it is ready when the stress needs it.
template <class T>
struct VolumeChange {
  T J_minus_one;
  T inverse_root;
};

/// The volume change of a displacement gradient H.
template <class T>
constexpr VolumeChange<T> volume_change(const Tensor<T>& H) {
  const T J_minus_one = jacobian_minus_one(H);
  return {J_minus_one, inverse_cube_root(T(1) + J_minus_one)};
}

/// cof F - I = tr H I - H^T + cof H.
template <class T>
constexpr Tensor<T> cofactor_minus_identity(const Tensor<T>& H) {
  Tensor<T> D = cofactor(H) - transpose(H);
  const T tr = trace(H);
  for (int i = 0; i < 3; ++i) D(i, i) = D(i, i) + tr;
  return D;
}

/// cof F of the deformation gradient F = I + H.
template <class T>
constexpr Tensor<T> deformation_cofactor(const Tensor<T>& H) {
  Tensor<T> c = cofactor(H) - transpose(H);
  const T diagonal = T(1) + trace(H);
  for (int i = 0; i < 3; ++i) c(i, i) = c(i, i) + diagonal;
  return c;
}

/// F F^T - I = H + H^T + H H^T, the left Cauchy-Green tensor without its unit part.
template <class T>
constexpr Tensor<T> left_cauchy_green_minus_identity(const Tensor<T>& H) {
  Tensor<T> e;
  for (int i = 0; i < 3; ++i) {
    for (int j = i; j < 3; ++j) {
      e(i, j) = (H(i, j) + H(j, i)) + (H(i, 0) * H(j, 0) + H(i, 1) * H(j, 1) + H(i, 2) * H(j, 2));
      e(j, i) = e(i, j);
    }
  }
  return e;
}

/// F S F^T for symmetric S.
template <class T>
constexpr Tensor<T> to_space(const Tensor<T>& S, const Tensor<T>& H) {
  const Tensor<T> FS = S + H * S;
  return FS + FS * transpose(H);
}

}  // namespace sandglass
