#pragma once

#include "element/element_motion.hpp"
#include "element/hourglass_settings.hpp"
#include "math/matrix.hpp"

namespace sandglass {

/// No hourglass control: the twelve hourglass modes of a one-point element have no energy.
struct NoHourglassControl {
  static constexpr HourglassTraits traits{.active = false};

  template <class T>
  struct Element {};
  template <class T>
  using History = NoHistory<T>;

  template <class Law>
  static Element<double> precompute(const NodalVectors<double>& /*X*/, const Law& /*law*/,
                                    const HourglassSettings& /*settings*/) {
    return {};
  }

  /// The same for any number type, from the element's geometry.
  template <class T, class Geometry, class Law>
  static Element<T> constants(const Geometry& /*body*/, const Law& /*law*/,
                              const HourglassSettings& /*settings*/) {
    return {};
  }
};

}  // namespace sandglass
