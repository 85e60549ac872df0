#pragma once

#include <algorithm>

#include "math/matrix.hpp"

namespace sandglass {

/// A symmetric matrix of N rows, stored as its N (N + 1) / 2 independent entries: the upper triangle by rows.
template <class T, int N>
struct SymmetricMatrix {
  std::array<T, static_cast<std::size_t>(N) * static_cast<std::size_t>(N + 1) / 2> entries;

  constexpr T& operator()(int i, int j) { return entries[index(i, j)]; }
  constexpr const T& operator()(int i, int j) const { return entries[index(i, j)]; }

  static constexpr std::size_t index(int i, int j) {
    const auto row = static_cast<std::size_t>(std::min(i, j));
    const auto column = static_cast<std::size_t>(std::max(i, j));
    return row * (2 * static_cast<std::size_t>(N) - row - 1) / 2 + column;
  }
};

/// The symmetric part of a matrix.
template <class T, int N>
constexpr SymmetricMatrix<T, N> symmetric_part(const Matrix<T, N, N>& a) {
  SymmetricMatrix<T, N> s;
  for (int i = 0; i < N; ++i) {
    for (int j = i; j < N; ++j) s(i, j) = T(0.5) * (a(i, j) + a(j, i));
  }
  return s;
}

/// All N^2 entries.
template <class T, int N>
constexpr Matrix<T, N, N> dense(const SymmetricMatrix<T, N>& s) {
  Matrix<T, N, N> a;
  for (int i = 0; i < N; ++i) {
    for (int j = 0; j < N; ++j) a(i, j) = s(i, j);
  }
  return a;
}

/// Row i of a times a column, of which column(n) is entry n.
template <class T, int N, class Column>
constexpr T row_product(const SymmetricMatrix<T, N>& a, int i, const Column& column) {
  T sum = a(i, 0) * column(0);
  for (int n = 1; n < N; ++n) sum = sum + a(i, n) * column(n);
  return sum;
}

template <class T, int N, int C>
constexpr Matrix<T, N, C> operator*(const SymmetricMatrix<T, N>& a, const Matrix<T, N, C>& b) {
  Matrix<T, N, C> c;
  for (int i = 0; i < N; ++i) {
    for (int j = 0; j < C; ++j) c(i, j) = row_product(a, i, [&](int n) { return b(n, j); });
  }
  return c;
}

/// The largest sum of absolute values in a row: no eigenvalue of the matrix is larger.
template <class T, int N>
T row_sum_bound(const Matrix<T, N, N>& a) {
  T largest = T(0);
  for (int i = 0; i < N; ++i) {
    T row = abs(a(i, 0));
    for (int j = 1; j < N; ++j) row = row + abs(a(i, j));
    largest = max(largest, row);
  }
  return largest;
}

}  // namespace sandglass
