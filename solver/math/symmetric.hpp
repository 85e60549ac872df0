#pragma once

#include "math/matrix.hpp"

namespace sandglass {

/// A symmetric tensor as its six entries 00, 11, 22, 01, 12, 02.
template <class T>
using Symmetric = Matrix<T, 6, 1>;

/// The index of entry (i, j) among the six.
constexpr int symmetric_entry(int i, int j) {
  return i == j ? i : i + j == 1 ? 3 : i + j == 3 ? 4 : 5;
}

/// The product a b, known to be symmetric.
template <class T>
constexpr Symmetric<T> symmetric_product(const Tensor<T>& a, const Tensor<T>& b) {
  Symmetric<T> c;
  for (int i = 0; i < 3; ++i) {
    for (int j = i; j < 3; ++j) {
      c(symmetric_entry(i, j), 0) = a(i, 0) * b(0, j) + a(i, 1) * b(1, j) + a(i, 2) * b(2, j);
    }
  }
  return c;
}

/// The six entries of a symmetric tensor.
template <class T>
constexpr Symmetric<T> six_entries(const Tensor<T>& a) {
  return {{a(0, 0), a(1, 1), a(2, 2), a(0, 1), a(1, 2), a(0, 2)}};
}

/// x I + s.
template <class T>
constexpr Symmetric<T> plus_identity(const T& x, Symmetric<T> s) {
  for (int i = 0; i < 3; ++i) s(i, 0) = x + s(i, 0);
  return s;
}

/// The cofactors, which are the adjugate's entries too.
template <class T>
constexpr Symmetric<T> cofactor(const Symmetric<T>& s) {
  const auto& [x, y, z, xy, yz, xz] = s.entries;
  return {{y * z - yz * yz, x * z - xz * xz, x * y - xy * xy, yz * xz - xy * z, xy * xz - x * yz,
           xy * yz - y * xz}};
}

/// All nine entries.
template <class T>
constexpr Tensor<T> full(const Symmetric<T>& s) {
  Tensor<T> a;
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) a(i, j) = s(symmetric_entry(i, j), 0);
  }
  return a;
}

/// s : s of the nine entries.
template <class T>
constexpr T norm_square(const Symmetric<T>& s) {
  const T diagonal = s(0, 0) * s(0, 0) + s(1, 0) * s(1, 0) + s(2, 0) * s(2, 0);
  return diagonal + T(2) * (s(3, 0) * s(3, 0) + s(4, 0) * s(4, 0) + s(5, 0) * s(5, 0));
}

}  // namespace sandglass
