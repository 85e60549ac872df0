#pragma once

#include <bit>
#include <concepts>
#include <cstdint>
#include <type_traits>

#include "math/exponential.hpp"

namespace sandglass {

namespace detail {

/// Vectors of W lanes in the compiler's vector types; integers of the same width for masks and bit
/// operations.
template <class T, int W>
struct VectorOf {
  using Integer = std::conditional_t<sizeof(T) == 8, std::int64_t, std::int32_t>;
  using Vector __attribute__((vector_size(sizeof(T) * W))) = T;
  using Mask __attribute__((vector_size(sizeof(T) * W))) = Integer;
};

}  // namespace detail

/// The number of lanes in a register of the target.
template <class T>
inline constexpr int native_width =
#if defined(__AVX512F__)
    64 / sizeof(T);
#elif defined(__AVX__)
    32 / sizeof(T);
#else
    16 / sizeof(T);
#endif

/// W numbers of type T, one for each element of a block, computed together. It provides the functions of
/// scalar.hpp, so a kernel written for one element runs on W of them.
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

  /// Rounded.
  template <class S>
  requires(!std::same_as<S, T>) explicit Pack(const Pack<S, W>& other)
      : lanes(__builtin_convertvector(other.lanes, Vector)) {}

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
  friend Pack max(Pack a, Pack b) { return select(a < b, b, a); }
  friend Pack min(Pack a, Pack b) { return select(b < a, b, a); }
  friend Pack abs(Pack a) { return select(a < Pack(T(0)), -a, a); }

  /// Whether all are zero.
  friend bool is_zero(Pack a) {
    for (int l = 0; l < W; ++l) {
      if (a.lanes[l] != T(0)) return false;
    }
    return true;
  }

  /// A loop over the lanes, compiled to one instruction because math functions do not set errno.
  friend Pack sqrt(Pack a) {
    for (int l = 0; l < W; ++l) a.lanes[l] = std::sqrt(a.lanes[l]);
    return a;
  }

  // As for plain numbers, see exponential.hpp.
  friend Pack log1p(Pack a) { return detail::logarithm_of_one_plus<T>(a); }
  friend Pack expm1(Pack a) { return detail::exponential_minus_one<T>(a); }
  friend Pack power_of_two(Pack n) {
    using Bits = detail::FloatBits<T>;
    const Vector shifted = n.lanes + (T(1.5) * Bits::integers + T(Bits::bias));
    return of(std::bit_cast<Vector>(std::bit_cast<Mask>(shifted) << Bits::mantissa));
  }
  friend Pack binary_exponent(Pack x) {
    using Bits = detail::FloatBits<T>;
    const Mask bits = std::bit_cast<Mask>(x.lanes) >> Bits::mantissa;
    const Mask shifted = bits | std::bit_cast<typename Bits::Integer>(Bits::integers);
    return of(std::bit_cast<Vector>(shifted) - (Bits::integers + T(Bits::bias)));
  }

  /// As for plain numbers, see scalar.hpp.
  friend Pack inverse_cube_root(Pack x) {
    using Guess = RootGuess<T>;
    const Mask logarithm = (std::bit_cast<Mask>(x.lanes) >> Guess::shift) | Guess::integers;
    const Vector root = Guess::start + Guess::slope * std::bit_cast<Vector>(logarithm);
    const Mask bits = std::bit_cast<Mask>(root) << Guess::shift;
    return refined_inverse_cube_root(x, of(std::bit_cast<Vector>(bits)));
  }
};

/// The number of elements that a number type computes together (1 for plain numbers, W for packs), and access
/// to one of them.
template <class Number>
struct Lanes {
  using Scalar = Number;
  static constexpr int width = 1;
  static Scalar get(const Number& number, int /*lane*/) { return number; }
  static void set(Number& number, int /*lane*/, Scalar value) { number = value; }
};

template <class T, int W>
struct Lanes<Pack<T, W>> {
  using Scalar = T;
  static constexpr int width = W;
  static Scalar get(const Pack<T, W>& pack, int lane) { return pack.lanes[lane]; }
  static void set(Pack<T, W>& pack, int lane, Scalar value) { pack.lanes[lane] = value; }
};

}  // namespace sandglass
