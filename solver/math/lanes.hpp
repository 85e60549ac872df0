#pragma once

#include "math/pack.hpp"

namespace sandglass {

/// How many elements a number type computes at once, and access to one of them: 1 for plain numbers, W for
/// packs.
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
