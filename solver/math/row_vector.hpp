#pragma once

#include "math/rows.hpp"

/// Rows in the compiler's vectors, for passes over rows that couple the components of a node.
namespace sandglass {

/// W numbers: W / 4 rows side by side.
template <class T, int W>
using RowVector = typename detail::VectorOf<T, W>::Vector;

/// W numbers from `numbers` on.
template <int W, class T>
RowVector<T, W> load(const T* numbers) {
  RowVector<T, W> vector;
  std::memcpy(&vector, numbers, sizeof vector);
  return vector;
}

/// Writes a vector to `numbers`.
template <class T, class Vector>
void store(const Vector& vector, T* numbers) {
  std::memcpy(numbers, &vector, sizeof vector);
}

}  // namespace sandglass
