#pragma once

#include <array>

#include "element/modes.hpp"
#include "mesh/hexahedron.hpp"

/// Gradients of a trilinear field at the corners of its parent cube from its modes, and the transpose, by
/// additions only.
namespace sandglass {

namespace detail {

/// A parent axis: the two others, and which of the hourglass modes eta zeta, xi zeta, xi eta vary along it
/// with the second axis and with the third; xi eta zeta varies with both.
struct ParentAxis {
  int second;
  int third;
  std::size_t with_second;
  std::size_t with_third;
};
inline constexpr std::array<ParentAxis, 3> parent_axes{{{1, 2, 2, 1}, {0, 2, 2, 0}, {0, 1, 1, 0}}};

/// The two corners on each of the four lines along a parent axis; lines are ordered by the signs along the
/// second, then the third axis.
using CornerLines = std::array<std::array<std::size_t, 2>, 4>;
constexpr CornerLines corner_lines(const ParentAxis& axis) {
  CornerLines lines{};
  std::array<std::size_t, 4> found{};
  for (std::size_t q = 0; q < 8; ++q) {
    const auto corner = static_cast<int>(q);
    const std::size_t line = (corner_signs(corner, axis.second) > 0.0 ? 1U : 0U) +
                             (corner_signs(corner, axis.third) > 0.0 ? 2U : 0U);
    lines[line][found[line]++] = q;
  }
  return lines;
}
inline constexpr std::array<CornerLines, 3> lines_along{
    corner_lines(parent_axes[0]), corner_lines(parent_axes[1]), corner_lines(parent_axes[2])};

}  // namespace detail

/// The corners of the parent cube, for the functions below. For points at +-g along each axis the bilinear
/// modes are scaled by g and the trilinear one by g^2.
struct AtCorners {
  template <class T>
  static T bilinear(const T& mode) {
    return mode;
  }
  template <class T>
  static T trilinear(const T& mode) {
    return mode;
  }
};

/// Parent gradients du_i/dxi_k at the eight points, times 8. The gradient along an axis is bilinear in the
/// two other coordinates and therefore has four different values.
template <class Points, class T>
std::array<Tensor<T>, 8> corner_gradients(const Modes<T>& modes) {
  std::array<Tensor<T>, 8> gradients;
  for (int i = 0; i < 3; ++i) {
    const std::array<T, 3> bilinear{Points::bilinear(modes(3, i)), Points::bilinear(modes(4, i)),
                                    Points::bilinear(modes(5, i))};
    const T trilinear = Points::trilinear(modes(6, i));
    for (int k = 0; k < 3; ++k) {
      const auto axis = static_cast<std::size_t>(k);
      const T b = bilinear[detail::parent_axes[axis].with_second];
      const T c = bilinear[detail::parent_axes[axis].with_third];
      const T low = modes(k, i) - b, high = modes(k, i) + b;  // by the sign along the second axis
      const T low_c = c - trilinear, high_c = c + trilinear;  // multiplied by the sign along the third axis
      const std::array<T, 4> values{low - low_c, high - high_c, low + low_c, high + high_c};
      for (std::size_t line = 0; line < 4; ++line) {
        for (const std::size_t q : detail::lines_along[axis][line]) gradients[q](i, k) = values[line];
      }
    }
  }
  return gradients;
}

/// The transpose of `corner_gradients`: modal forces of fluxes at the points.
template <class Points, class T>
Modes<T> corner_divergence(const std::array<Tensor<T>, 8>& flux) {
  Modes<T> f;
  for (int i = 0; i < 3; ++i) {
    std::array<T, 3> bilinear{T(0), T(0), T(0)};
    T trilinear = T(0);
    for (int k = 0; k < 3; ++k) {
      const auto axis = static_cast<std::size_t>(k);
      std::array<T, 4> values;
      for (std::size_t line = 0; line < 4; ++line) {
        const auto& [q, r] = detail::lines_along[axis][line];
        values[line] = flux[q](i, k) + flux[r](i, k);
      }
      const T low = values[0] + values[1], high = values[2] + values[3];
      const T low_b = values[1] - values[0], high_b = values[3] - values[2];
      T& second = bilinear[detail::parent_axes[axis].with_second];
      T& third = bilinear[detail::parent_axes[axis].with_third];
      f(k, i) = low + high;
      second = second + (low_b + high_b);
      third = third + (high - low);
      trilinear = trilinear + (high_b - low_b);
    }
    for (int a = 0; a < 3; ++a) f(3 + a, i) = Points::bilinear(bilinear[static_cast<std::size_t>(a)]);
    f(6, i) = Points::trilinear(trilinear);
  }
  return f;
}

}  // namespace sandglass
