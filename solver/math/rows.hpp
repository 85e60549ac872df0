#pragma once

#include <array>
#include <cstdint>
#include <cstring>
#include <utility>
#include <vector>

#include "math/pack.hpp"

/// Nodal values as the time loop stores them, and their transfer into packs and back.
namespace sandglass {

/// The three components of one node, padded with a zero so that one instruction loads or stores them.
template <class T>
struct alignas(4 * sizeof(T)) Row {
  std::array<T, 4> x{};

  T& operator[](std::size_t i) { return x[i]; }
  const T& operator[](std::size_t i) const { return x[i]; }
};

/// One row per node, in the order of the time loop.
template <class T>
using Rows = std::vector<Row<T>>;

/// The numbers of all rows, one after another.
template <class T>
const T* numbers_of(const Rows<T>& rows) {
  return rows.data()->x.data();
}
template <class T>
T* numbers_of(Rows<T>& rows) {
  return rows.data()->x.data();
}

/// The index of a row's first number among them, usable as an address without further arithmetic.
using Place = std::uint32_t;
constexpr Place place_of_row(std::size_t row) {
  return static_cast<Place>(4 * row);
}

/// W numbers in the compiler's vectors: W / 4 rows side by side.
template <class T, int W>
using RowVector = typename detail::VectorOf<T, W>::Vector;

/// Loads W numbers from `numbers`.
template <int W, class T>
RowVector<T, W> load(const T* numbers) {
  RowVector<T, W> vector;
  std::memcpy(&vector, numbers, sizeof vector);
  return vector;
}

/// Stores a vector to `numbers`.
template <class T, class Vector>
void store(const Vector& vector, T* numbers) {
  std::memcpy(numbers, &vector, sizeof vector);
}

namespace detail {

/// A vector of lanes of two vectors: lane l of the result is lane pick(l, W), where lanes of the second
/// vector are numbered from W.
template <int (*pick)(int, int), int Width, class Vector>
auto permute(Vector a, Vector b) {
  constexpr int W = sizeof(Vector) / sizeof(a[0]);
  return [&]<int... lane>(std::integer_sequence<int, lane...>) {
    return __builtin_shufflevector(a, b, pick(lane, W)...);
  }
  (std::make_integer_sequence<int, Width>{});
}

// Patterns. Vectors hold rows of four, and each pattern repeats in every four lanes; lanes of 64 bits stay
// within 128 bits where possible.
constexpr int in_order(int lane, int /*W*/) {
  return lane;
}
constexpr int second_half(int lane, int W) {
  return lane + W / 2;
}
/// (a0 b0 a2 b2) and (a1 b1 a3 b3).
constexpr int even(int lane, int W) {
  return lane / 2 * 2 + lane % 2 * W;
}
constexpr int odd(int lane, int W) {
  return even(lane, W) + 1;
}
/// (a0 b0 a1 b1) and (a2 b2 a3 b3).
constexpr int low(int lane, int W) {
  return lane / 4 * 4 + lane % 4 / 2 + lane % 2 * W;
}
constexpr int high(int lane, int W) {
  return low(lane, W) + 2;
}
/// (a0 a1 b0 b1) and (a2 a3 b2 b3).
constexpr int low_pairs(int lane, int W) {
  return lane / 4 * 4 + lane % 2 + lane % 4 / 2 * W;
}
constexpr int high_pairs(int lane, int W) {
  return low_pairs(lane, W) + 2;
}

/// The rows at place[0], place[4], place[8], ... side by side.
template <int Width, class T>
RowVector<T, Width> load_rows(const T* rows, const Place* place) {
  if constexpr (Width == 4) {
    return load<4>(rows + *place);
  } else {
    return permute<in_order, Width>(load_rows<Width / 2>(rows, place),
                                    load_rows<Width / 2>(rows, place + Width / 2));
  }
}

/// Adds vectors of four to the rows at place[0], place[4], place[8], ...
template <int Width, class T>
void add_to_rows(T* rows, const Place* place, RowVector<T, Width> values) {
  if constexpr (Width == 4) {
    store(load<4>(rows + *place) + values, rows + *place);
  } else {
    add_to_rows<Width / 2>(rows, place, permute<in_order, Width / 2>(values, values));
    add_to_rows<Width / 2>(rows, place + Width / 2, permute<second_half, Width / 2>(values, values));
  }
}

template <class Number>
inline constexpr bool transposes = Lanes<Number>::width % 4 == 0;

}  // namespace detail

/// The three components of as many rows as `Number` has lanes, the row at place[l] in lane l: vector loads
/// and a transpose in registers where vectors hold rows of four.
template <class Number, class T>
std::array<Number, 3> gather(const T* rows, const Place* place) {
  constexpr int W = Lanes<Number>::width;
  if constexpr (detail::transposes<Number>) {
    using namespace detail;
    const auto a = load_rows<W>(rows, place), b = load_rows<W>(rows, place + 1);
    const auto c = load_rows<W>(rows, place + 2), d = load_rows<W>(rows, place + 3);
    if constexpr (sizeof(T) == 8) {
      const auto ab = permute<even, W>(a, b), cd = permute<even, W>(c, d);
      const auto y = permute<low_pairs, W>(permute<odd, W>(a, b), permute<odd, W>(c, d));
      return {Number::of(permute<low_pairs, W>(ab, cd)), Number::of(y),
              Number::of(permute<high_pairs, W>(ab, cd))};
    } else {
      const auto ab = permute<low, W>(a, b), cd = permute<low, W>(c, d);
      const auto z = permute<low_pairs, W>(permute<high, W>(a, b), permute<high, W>(c, d));
      return {Number::of(permute<low_pairs, W>(ab, cd)), Number::of(permute<high_pairs, W>(ab, cd)),
              Number::of(z)};
    }
  } else {
    std::array<Number, 3> x;
    for (int lane = 0; lane < W; ++lane) {
      for (std::size_t i = 0; i < 3; ++i) Lanes<Number>::set(x[i], lane, rows[place[lane] + i]);
    }
    return x;
  }
}

/// Adds the three components of lane l to the row at place[l], one lane after another, so that several lanes
/// may add to the same row.
template <class Number, class T>
void scatter_add(const std::array<Number, 3>& x, T* rows, const Place* place) {
  constexpr int W = Lanes<Number>::width;
  if constexpr (detail::transposes<Number>) {
    using namespace detail;
    const RowVector<T, W> zero{};
    const auto add = [&](int lane, auto xy, auto z, bool upper) {
      add_to_rows<W>(rows, place + lane,
                     upper ? permute<high_pairs, W>(xy, z) : permute<low_pairs, W>(xy, z));
    };
    if constexpr (sizeof(T) == 8) {
      const auto xy02 = permute<even, W>(x[0].lanes, x[1].lanes), z02 = permute<even, W>(x[2].lanes, zero);
      const auto xy13 = permute<odd, W>(x[0].lanes, x[1].lanes), z13 = permute<odd, W>(x[2].lanes, zero);
      add(0, xy02, z02, false);
      add(1, xy13, z13, false);
      add(2, xy02, z02, true);
      add(3, xy13, z13, true);
    } else {
      const auto xy01 = permute<low, W>(x[0].lanes, x[1].lanes), z01 = permute<low, W>(x[2].lanes, zero);
      const auto xy23 = permute<high, W>(x[0].lanes, x[1].lanes), z23 = permute<high, W>(x[2].lanes, zero);
      add(0, xy01, z01, false);
      add(1, xy01, z01, true);
      add(2, xy23, z23, false);
      add(3, xy23, z23, true);
    }
  } else {
    for (int lane = 0; lane < W; ++lane) {
      for (std::size_t i = 0; i < 3; ++i) rows[place[lane] + i] += Lanes<Number>::get(x[i], lane);
    }
  }
}

}  // namespace sandglass
