#pragma once

#include <bit>
#include <concepts>
#include <cstdint>
#include <type_traits>

#include "math/scalar.hpp"

namespace sandglass {

namespace detail {

/// Vectors of W lanes in the compiler's own types; integers of the same width for masks and bit tricks.
template <class T, int W>
struct VectorOf {
  using Integer = std::conditional_t<sizeof(T) == 8, std::int64_t, std::int32_t>;
  using Vector __attribute__((vector_size(sizeof(T) * W))) = T;
  using Mask __attribute__((vector_size(sizeof(T) * W))) = Integer;
  using FloatVector __attribute__((vector_size(sizeof(float) * W))) = float;
  using IntVector __attribute__((vector_size(sizeof(std::int32_t) * W))) = std::int32_t;
};

}  // namespace detail

/// Lanes that one register of the target holds.
template <class T>
inline constexpr int native_width =
#if defined(__AVX512F__)
    64 / sizeof(T);
#elif defined(__AVX__)
    32 / sizeof(T);
#else
    16 / sizeof(T);
#endif

/// W numbers of type T, one per element of a block, computed together. It is a number type of the vocabulary
/// in scalar.hpp, so that a kernel written for one element runs on W of them.
template <class T, int W = native_width<T>>
struct Pack {
  using Scalar = T;
  using Vector = typename detail::VectorOf<T, W>::Vector;
  using Mask = typename detail::VectorOf<T, W>::Mask;
  static constexpr int width = W;

  Vector lanes;

  Pack() = default;
  explicit(false) Pack(T same) : lanes(same - Vector{}) {}
  template <std::floating_point S>
  requires(!std::same_as<S, T>) explicit Pack(S same) : Pack(static_cast<T>(same)) {}

  /// From the compiler's vector; a constructor would collide with the one from a number.
  static Pack of(Vector lanes) {
    Pack pack;
    pack.lanes = lanes;
    return pack;
  }

  friend Pack operator+(Pack a, Pack b) { return of(a.lanes + b.lanes); }
  friend Pack operator-(Pack a, Pack b) { return of(a.lanes - b.lanes); }
  friend Pack operator-(Pack a) { return of(-a.lanes); }
  friend Pack operator*(Pack a, Pack b) { return of(a.lanes * b.lanes); }
  friend Pack operator/(Pack a, Pack b) { return of(a.lanes / b.lanes); }
  friend Mask operator<(Pack a, Pack b) { return a.lanes < b.lanes; }
  friend Mask operator>(Pack a, Pack b) { return a.lanes > b.lanes; }

  friend Pack select(Mask mask, Pack a, Pack b) { return of(mask ? a.lanes : b.lanes); }
  friend bool any(Mask mask) {
    bool found = false;
    for (int l = 0; l < W; ++l) found = found || mask[l] != 0;
    return found;
  }
  friend Pack max(Pack a, Pack b) { return select(a < b, b, a); }
  friend Pack min(Pack a, Pack b) { return select(b < a, b, a); }
  friend Pack abs(Pack a) { return select(a < Pack(T(0)), -a, a); }

  // Outside the time loop: lane by lane.
  friend Pack sqrt(Pack a) {
    return each(a, [](T x) { return std::sqrt(x); });
  }
  friend Pack log1p(Pack a) {
    return each(a, [](T x) { return std::log1p(x); });
  }
  friend Pack expm1(Pack a) {
    return each(a, [](T x) { return std::expm1(x); });
  }

  /// As for plain numbers, see scalar.hpp.
  friend Pack inverse_cube_root(Pack x) {
    using FloatVector = typename detail::VectorOf<T, W>::FloatVector;
    using IntVector = typename detail::VectorOf<T, W>::IntVector;
    const auto bits = std::bit_cast<IntVector>(__builtin_convertvector(x.lanes, FloatVector));
    const auto root_bits = __builtin_convertvector(
        __builtin_convertvector(bits, FloatVector) * cube_root_slope + cube_root_shift, IntVector);
    return refined_inverse_cube_root(
        x, of(__builtin_convertvector(std::bit_cast<FloatVector>(root_bits), Vector)));
  }

 private:
  template <class Function>
  static Pack each(Pack a, Function function) {
    for (int l = 0; l < W; ++l) a.lanes[l] = function(a.lanes[l]);
    return a;
  }
};

}  // namespace sandglass
