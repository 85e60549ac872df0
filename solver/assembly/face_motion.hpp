#pragma once

#include "element/element_motion.hpp"

namespace sandglass {

/// A face's part of an `ElementMotion`.
template <class Number>
struct FaceMotion {
  FaceModes<Number> u;
  FaceModes<Number> increment;
  FaceModes<Number> X;
  std::array<Number, 4> dilatation;
};

/// The motion of the elements between two faces, as far as their kernel needs it.
template <class Kernel, class Number>
ElementMotion<Number> motion_between(const FaceMotion<Number>& lower, const FaceMotion<Number>& upper,
                                     const Number& inverse_step) {
  ElementMotion<Number> motion;
  motion.inverse_step = inverse_step;
  motion.u = modes_between(lower.u, upper.u);
  if constexpr (Kernel::needs_increment) motion.increment = modes_between(lower.increment, upper.increment);
  if constexpr (Kernel::needs_coordinates) motion.X = modes_between(lower.X, upper.X);
  if constexpr (Kernel::averages_over_nodes) {
    std::copy(lower.dilatation.begin(), lower.dilatation.end(), motion.dilatation.begin());
    std::copy(upper.dilatation.begin(), upper.dilatation.end(), motion.dilatation.begin() + 4);
  }
  return motion;
}

}  // namespace sandglass
