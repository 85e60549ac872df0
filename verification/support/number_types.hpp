#pragma once

#include "base/type_list.hpp"
#include "counting/counted.hpp"
#include "math/dual.hpp"
#include "math/pack.hpp"
#include "math/recorded.hpp"

namespace sandglass::verification {

/// The number types of kernels; vocabulary_test.cpp tests each for the functions of scalar.hpp.
using NumberTypes = TypeList<double, float, Pack<double>, Pack<float>, Dual<double>, Counted, Recorded>;

/// The plain value of a number, without its slope, tally or other lanes.
template <class Number>
double plain_value(const Number& x) {
  if constexpr (requires { x.lanes; }) {
    return static_cast<double>(x.lanes[0]);
  } else if constexpr (requires { x.value(); }) {
    return x.value();
  } else if constexpr (requires { x.value; }) {
    return plain_value(x.value);
  } else {
    return static_cast<double>(x);
  }
}

}  // namespace sandglass::verification
