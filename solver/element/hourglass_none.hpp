#pragma once

#include "element/hourglass_settings.hpp"
#include "math/matrix.hpp"

namespace sandglass {

/// No hourglass control: the twelve hourglass modes of a one-point element stay without energy.
struct NoHourglassControl {
  static constexpr bool takes_kappa = false;

  template <class T>
  struct Element {};

  template <class Law>
  static Element<double> precompute(const NodalVectors<double>& /*X*/, const Law& /*law*/,
                                    const HourglassSettings& /*settings*/) {
    return {};
  }

  template <class T>
  static NodalVectors<T> force(const NodalVectors<T>& /*u*/, const Tensor<T>& /*H*/,
                               const Element<T>& /*element*/) {
    return {};
  }

  template <class T>
  static T energy(const NodalVectors<T>& /*u*/, const Tensor<T>& /*H*/, const Element<T>& /*element*/) {
    return T(0);
  }

  template <class T>
  static T stiffness_bound(const Element<T>& /*element*/) {
    return T(0);
  }
};

}  // namespace sandglass
