#pragma once

#include <array>
#include <cstddef>

#include "math/exponential.hpp"

namespace sandglass {

/// A small dense matrix of R rows and C columns, stored by rows. An aggregate: `Matrix<double, 2, 2>{{1, 2,
/// 3, 4}}`. Without an initialiser its entries are unset, as for plain numbers: clearing them would cost the
/// kernels time.
template <class T, int R, int C>
struct Matrix {
  static constexpr int rows = R, columns = C;

  std::array<T, static_cast<std::size_t>(R) * static_cast<std::size_t>(C)> entries;

  constexpr T& operator()(int i, int j) { return entries[index(i, j)]; }
  constexpr const T& operator()(int i, int j) const { return entries[index(i, j)]; }

  static constexpr std::size_t index(int i, int j) {
    return static_cast<std::size_t>(i) * static_cast<std::size_t>(C) + static_cast<std::size_t>(j);
  }

  constexpr Matrix& operator+=(const Matrix& other) {
    for (std::size_t n = 0; n < entries.size(); ++n) entries[n] = entries[n] + other.entries[n];
    return *this;
  }
};

/// Second-order tensor in three dimensions.
template <class T>
using Tensor = Matrix<T, 3, 3>;

/// Three components.
template <class T>
using Triple = Matrix<T, 3, 1>;

/// The unit tensor.
template <class T>
constexpr Tensor<T> identity() {
  return {{T(1), T(0), T(0), T(0), T(1), T(0), T(0), T(0), T(1)}};
}

// Operands are taken by reference and results filled entry by entry, because GCC calls memcpy to copy packs.

template <class T, int R, int C>
constexpr Matrix<T, R, C> operator+(const Matrix<T, R, C>& a, const Matrix<T, R, C>& b) {
  Matrix<T, R, C> sum;
  for (std::size_t n = 0; n < sum.entries.size(); ++n) sum.entries[n] = a.entries[n] + b.entries[n];
  return sum;
}

template <class T, int R, int C>
constexpr Matrix<T, R, C> operator-(const Matrix<T, R, C>& a, const Matrix<T, R, C>& b) {
  Matrix<T, R, C> difference;
  for (std::size_t n = 0; n < a.entries.size(); ++n) difference.entries[n] = a.entries[n] - b.entries[n];
  return difference;
}

template <class T, int R, int C>
constexpr Matrix<T, R, C> operator*(const T& s, const Matrix<T, R, C>& a) {
  Matrix<T, R, C> product;
  for (std::size_t n = 0; n < a.entries.size(); ++n) product.entries[n] = s * a.entries[n];
  return product;
}

template <class T, int R, int N, int C>
constexpr Matrix<T, R, C> operator*(const Matrix<T, R, N>& a, const Matrix<T, N, C>& b) {
  Matrix<T, R, C> c;
  for (int i = 0; i < R; ++i) {
    for (int j = 0; j < C; ++j) {
      T sum = a(i, 0) * b(0, j);
      for (int n = 1; n < N; ++n) sum = sum + a(i, n) * b(n, j);
      c(i, j) = sum;
    }
  }
  return c;
}

/// a^T.
template <class T, int R, int C>
constexpr Matrix<T, C, R> transpose(const Matrix<T, R, C>& a) {
  Matrix<T, C, R> t;
  for (int i = 0; i < R; ++i) {
    for (int j = 0; j < C; ++j) t(j, i) = a(i, j);
  }
  return t;
}

/// The product of all entries, a : b.
template <class T, int R, int C>
constexpr T double_dot(const Matrix<T, R, C>& a, const Matrix<T, R, C>& b) {
  T sum = a.entries[0] * b.entries[0];
  for (std::size_t n = 1; n < a.entries.size(); ++n) sum = sum + a.entries[n] * b.entries[n];
  return sum;
}

/// A matrix of constants as another number type.
template <class T, int R, int C>
constexpr Matrix<T, R, C> from_double(const Matrix<double, R, C>& a) {
  Matrix<T, R, C> b;
  for (std::size_t n = 0; n < a.entries.size(); ++n) b.entries[n] = T(a.entries[n]);
  return b;
}

/// tr a.
template <class T>
constexpr T trace(const Tensor<T>& a) {
  return a(0, 0) + a(1, 1) + a(2, 2);
}

/// The deviator of a tensor, a - tr(a)/3 I.
template <class T>
constexpr Tensor<T> deviator(const Tensor<T>& a) {
  const T third = trace(a) * T(1.0 / 3.0);
  Tensor<T> d;
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) d(i, j) = i == j ? a(i, i) - third : a(i, j);
  }
  return d;
}

/// The cofactor matrix, det(a) a^-T, without a division.
template <class T>
constexpr Tensor<T> cofactor(const Tensor<T>& a) {
  return {{a(1, 1) * a(2, 2) - a(1, 2) * a(2, 1), a(1, 2) * a(2, 0) - a(1, 0) * a(2, 2),
           a(1, 0) * a(2, 1) - a(1, 1) * a(2, 0), a(0, 2) * a(2, 1) - a(0, 1) * a(2, 2),
           a(0, 0) * a(2, 2) - a(0, 2) * a(2, 0), a(0, 1) * a(2, 0) - a(0, 0) * a(2, 1),
           a(0, 1) * a(1, 2) - a(0, 2) * a(1, 1), a(0, 2) * a(1, 0) - a(0, 0) * a(1, 2),
           a(0, 0) * a(1, 1) - a(0, 1) * a(1, 0)}};
}

/// a x b.
template <class T>
constexpr Triple<T> cross(const Triple<T>& a, const Triple<T>& b) {
  return {{a(1, 0) * b(2, 0) - a(2, 0) * b(1, 0), a(2, 0) * b(0, 0) - a(0, 0) * b(2, 0),
           a(0, 0) * b(1, 0) - a(1, 0) * b(0, 0)}};
}

/// det a.
template <class T>
constexpr T determinant(const Tensor<T>& a) {
  return a(0, 0) * (a(1, 1) * a(2, 2) - a(1, 2) * a(2, 1)) +
         a(0, 1) * (a(1, 2) * a(2, 0) - a(1, 0) * a(2, 2)) +
         a(0, 2) * (a(1, 0) * a(2, 1) - a(1, 1) * a(2, 0));
}

/// a^-1 of a regular a.
template <class T>
constexpr Tensor<T> inverse(const Tensor<T>& a) {
  return (T(1) / determinant(a)) * transpose(cofactor(a));
}

/// An upper bound of the largest eigenvalue of a symmetric tensor with non-negative eigenvalues, sharp when
/// the two smaller ones are equal: tr/3 + sqrt(2/3) |dev|.
template <class T>
T largest_eigenvalue_bound(const Tensor<T>& symmetric) {
  const Tensor<T> dev = deviator(symmetric);
  return trace(symmetric) * T(1.0 / 3.0) + T(std::sqrt(2.0 / 3.0)) * sqrt(double_dot(dev, dev));
}

}  // namespace sandglass
