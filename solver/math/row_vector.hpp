#pragma once

#include "math/rows.hpp"

/// Several rows in one of the compiler's vectors, for passes over rows that couple the components of a node.
namespace sandglass {

/// W numbers: W / 4 rows side by side.
template <class T, int W>
using RowVector = typename detail::VectorOf<T, W>::Vector;

/// The numbers that a pass takes at a time: as many whole rows as a register holds.
template <class T>
inline constexpr int row_vector_width = std::max(4, native_width<T>);

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

/// The sum of all lanes, in order of the lanes.
template <class Vector>
double sum_of_lanes(const Vector& vector) {
  double sum = 0.0;
  for (std::size_t l = 0; l < sizeof vector / sizeof vector[0]; ++l) sum += static_cast<double>(vector[l]);
  return sum;
}

namespace detail {

/// (y z x) and (z x y) of every row (x y z).
constexpr int next_component(int lane, int /*W*/) {
  return lane % 4 == 3 ? lane : lane / 4 * 4 + (lane % 4 + 1) % 3;
}
constexpr int component_after_next(int lane, int /*W*/) {
  return lane % 4 == 3 ? lane : lane / 4 * 4 + (lane % 4 + 2) % 3;
}
/// Both halves side by side.
constexpr int halves(int lane, int /*W*/) {
  return lane;
}

}  // namespace detail

/// A symmetric 3 x 3 block times the vector of each row; `diagonal` holds xx, yy, zz and `mixed` yz, zx, xy.
template <int W, class Vector>
Vector symmetric_product(const Vector& diagonal, const Vector& mixed, const Vector& r) {
  using namespace detail;
  const Vector mixed_next = permute<next_component, W>(mixed, mixed);
  const Vector mixed_after = permute<component_after_next, W>(mixed, mixed);
  const Vector r_next = permute<next_component, W>(r, r);
  const Vector r_after = permute<component_after_next, W>(r, r);
  return diagonal * r + mixed_after * r_next + mixed_next * r_after;
}

/// Calls body.operator()<W>(k) for numbers k of `first` to `last` - 1 in steps of W, for as many numbers as a
/// register holds and then for single rows.
template <class T, class Body>
void for_each_row_vector(std::size_t first, std::size_t last, const Body& body) {
  constexpr int W = row_vector_width<T>;
  std::size_t k = first;
  for (; k + W <= last; k += W) body.template operator()<W>(k);
  for (; k < last; k += 4) body.template operator()<4>(k);
}

}  // namespace sandglass
