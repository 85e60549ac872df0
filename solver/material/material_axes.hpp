#pragma once

#include "math/matrix.hpp"

namespace sandglass {

/// The axes of an anisotropic material in the undeformed body, an orthonormal right-handed frame by rows: the
/// direction of its fibres, one across them in its sheets, and the normal of the sheets. Laws are written in
/// these axes, where H becomes A H A^T.
template <class T>
using MaterialAxes = Tensor<T>;

/// A H A^T: a tensor, transformed from space to material axes.
template <class T>
Tensor<T> in_material(const MaterialAxes<T>& A, const Tensor<T>& H) {
  return A * H * transpose(A);
}

/// A^T P A: the inverse transformation.
template <class T>
Tensor<T> in_space(const MaterialAxes<T>& A, const Tensor<T>& P) {
  return transpose(A) * P * A;
}

/// A law in elements with these axes, one element in each lane; null means the axes of space. A law without
/// axes is returned unchanged.
template <class Law, class T>
constexpr decltype(auto) with_axes(const Law& law, const MaterialAxes<T>* axes) {
  if constexpr (requires { law.with_axes(axes); }) {
    return law.with_axes(axes);
  } else {
    return (law);
  }
}

}  // namespace sandglass
