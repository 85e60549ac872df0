#pragma once

#include <array>

#include "element/hourglass_none.hpp"
#include "element/one_point.hpp"

namespace sandglass {

/// Average over the element's reference volume of values at its Gauss points.
template <class T, class Element>
T volume_average(const std::array<T, 8>& values, const Element& element) {
  T sum = element.weight[0] * values[0];
  for (std::size_t q = 1; q < 8; ++q) sum = sum + element.weight[q] * values[q];
  return sum / element.V;
}

/// The pressure at each point from the volume change there.
struct PointPressure {
  static constexpr bool shared = false;
  template <class T, class Element>
  static std::array<T, 8> dilatations(const std::array<T, 8>& own, const Element& /*element*/) {
    return own;
  }
};

/// One pressure from the element's volume change: Jbar - 1 = (1/V) sum_q w_q (J_q - 1). It is the Q1-P0 mixed
/// element with its pressure eliminated.
struct MeanPressure {
  static constexpr bool shared = true;
  template <class T, class Element>
  static std::array<T, 8> dilatations(const std::array<T, 8>& own, const Element& element) {
    std::array<T, 8> mean;
    mean.fill(volume_average(own, element));
    return mean;
  }
};

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

/// The two Gauss points on each of the four lines along a parent axis; lines are ordered by the signs along
/// the second, then the third axis. Gauss points stand in the order of the corners.
using GaussLines = std::array<std::array<std::size_t, 2>, 4>;
constexpr GaussLines gauss_lines(const ParentAxis& axis) {
  GaussLines lines{};
  std::array<std::size_t, 4> found{};
  for (std::size_t q = 0; q < 8; ++q) {
    const auto corner = static_cast<int>(q);
    const std::size_t line = (corner_signs(corner, axis.second) > 0.0 ? 1U : 0U) +
                             (corner_signs(corner, axis.third) > 0.0 ? 2U : 0U);
    lines[line][found[line]++] = q;
  }
  return lines;
}
inline constexpr std::array<GaussLines, 3> lines_along{
    gauss_lines(parent_axes[0]), gauss_lines(parent_axes[1]), gauss_lines(parent_axes[2])};

}  // namespace detail

/// The hexahedron with 2x2x2 Gauss points. Pressure is a policy: `PointPressure` gives the displacement
/// element, which locks as nu -> 1/2; `MeanPressure` the mean-dilatation element, the explicit twin of the
/// mixed Q1-P0 element. It has no hourglass modes, hence takes no control.
template <class Pressure>
struct EightPoint {
  /// What is constant in time.
  template <class T>
  struct Element {
    std::array<Tensor<T>, 8>
        inverse_jacobian;     ///< dxi_k/dX_j at the Gauss points, 1/m, times 1/8 for modes are sums
    std::array<T, 8> weight;  ///< det(dX/dxi) at the Gauss points, m^3
    T V;                      ///< reference volume, m^3
  };

  static constexpr bool needs_increment = false;
  static constexpr bool needs_coordinates = false;
  static constexpr bool averages_pressure = Pressure::shared;
  using NoControl = NoHourglassControl;

  static Element<double> precompute(const NodalVectors<double>& X) {
    Element<double> element{};
    const auto points = gauss_points();
    for (std::size_t q = 0; q < 8; ++q) {
      const Tensor<double> jacobian = parent_jacobian(X, points[q]);
      element.inverse_jacobian[q] = 0.125 * inverse(jacobian);
      element.weight[q] = determinant(jacobian);
      element.V += element.weight[q];
    }
    return element;
  }

  /// What the force needs of the displacements, at each Gauss point.
  template <class T>
  struct Deformation {
    std::array<Tensor<T>, 8> H;
    std::array<T, 8> inverse_root;
    std::array<T, 8> J_minus_one;
  };

  template <class Hourglass, class T>
  static Deformation<T> deformation(const ElementMotion<T>& motion, const Element<T>& element) {
    Deformation<T> now;
    const auto gradients = parent_gradients(motion.u);
    for (std::size_t q = 0; q < 8; ++q) {
      now.H[q] = gradients[q] * element.inverse_jacobian[q];
      const VolumeChange<T> change = volume_change(now.H[q]);
      now.J_minus_one[q] = change.J_minus_one;
      now.inverse_root[q] = change.inverse_root;
    }
    return now;
  }

  /// Internal forces (N) in modes: sum_q w_q B_q (P_iso(H_q) + p_q cof F_q)^T.
  template <class Hourglass, class T, class Law>
  static Modes<T> force(const Deformation<T>& now, const Element<T>& element,
                        const NoControl::Element<T>& /*control*/, NoHistory<T>& /*history*/, const Law& law) {
    const auto dilatation = Pressure::dilatations(now.J_minus_one, element);
    std::array<Tensor<T>, 8> flux;  // w P J^-T, the stress that the parent gradient carries
    for (std::size_t q = 0; q < 8; ++q) {
      const VolumeChange<T> change{now.J_minus_one[q], now.inverse_root[q]};
      flux[q] = law.weighted_piola(element.weight[q], now.H[q], change, law.pressure(dilatation[q])) *
                transpose(element.inverse_jacobian[q]);
    }
    return parent_divergence(flux);
  }

  /// Strain energy (J).
  template <class Hourglass, class T, class Law>
  static ElementEnergy<T> energy(const ElementMotion<T>& motion, const Element<T>& element,
                                 const NoControl::Element<T>& /*control*/, const NoHistory<T>& /*history*/,
                                 const Law& law) {
    const auto H = point_gradients(motion, element);
    const auto dilatation = Pressure::dilatations(point_dilatations(H), element);
    T W = T(0);
    for (std::size_t q = 0; q < 8; ++q) {
      W = W + element.weight[q] * (law.isochoric_energy(H[q]) + law.volumetric_energy(dilatation[q]));
    }
    return {W, T(0)};
  }

  /// Reference volume, m^3.
  template <class T>
  static T volume(const ElementMotion<T>& /*motion*/, const Element<T>& element) {
    return element.V;
  }

  template <class T>
  static T smallest_jacobian(const ElementMotion<T>& motion, const Element<T>& element) {
    const auto dilatation = point_dilatations(point_gradients(motion, element));
    T smallest = dilatation[0];
    for (std::size_t q = 1; q < 8; ++q) smallest = min(smallest, dilatation[q]);
    return T(1) + smallest;
  }

  template <class T>
  static T mean_jacobian(const ElementMotion<T>& motion, const Element<T>& element) {
    return T(1) + volume_average(point_dilatations(point_gradients(motion, element)), element);
  }

  /// An upper bound of the largest eigenvalue (N/m) of the tangent stiffness: the points' bounds add up,
  /// and the stiffness of a pressure that is one for the element acts on one mean spatial gradient.
  template <class Hourglass, class T, class Law>
  static T stiffness_bound(const ElementMotion<T>& motion, const Element<T>& element,
                           const NoControl::Element<T>& /*control*/, const Law& law) {
    const auto H = point_gradients(motion, element);
    const auto own_dilatation = point_dilatations(H);
    const auto dilatation = Pressure::dilatations(own_dilatation, element);
    const auto points = gauss_points();
    T bound = T(0);
    NodalVectors<T> mean_spatial_gradient{};
    for (std::size_t q = 0; q < 8; ++q) {
      const Tensor<T> to_space = T(8) * (element.inverse_jacobian[q] * inverse(identity<T>() + H[q]));
      const NodalVectors<T> g = from_double<T>(parent_gradient(points[q])) * to_space;
      const T J = T(1) + own_dilatation[q];
      const T bulk = Pressure::shared ? T(0) : law.bulk_tangent(dilatation[q]);
      const auto point = tangent_bound(law, H[q], own_dilatation[q], law.pressure(dilatation[q]), bulk);
      bound = bound + element.weight[q] * gradient_bound(point, g);
      mean_spatial_gradient += (element.weight[q] * J / element.V) * g;
    }
    if constexpr (Pressure::shared) {
      bound = bound + element.V * law.bulk_tangent(dilatation[0]) *
                          double_dot(mean_spatial_gradient, mean_spatial_gradient);
    }
    return bound;
  }

 private:
  static constexpr double g = gauss_coordinate;

  /// Parent gradients du_i/dxi_k at the Gauss points, times 8. Along each axis the gradient is bilinear in
  /// the two others, so that it has four values: additions of modes scaled once by g and g^2.
  template <class T>
  static std::array<Tensor<T>, 8> parent_gradients(const Modes<T>& modes) {
    std::array<Tensor<T>, 8> gradients;
    for (int i = 0; i < 3; ++i) {
      const std::array<T, 3> bilinear{T(g) * modes(3, i), T(g) * modes(4, i), T(g) * modes(5, i)};
      const T trilinear = T(g * g) * modes(6, i);
      for (int k = 0; k < 3; ++k) {
        const auto axis = static_cast<std::size_t>(k);
        const T b = bilinear[detail::parent_axes[axis].with_second];
        const T c = bilinear[detail::parent_axes[axis].with_third];
        const T low = modes(k, i) - b, high = modes(k, i) + b;  // by the sign along the second axis
        const T low_c = c - trilinear, high_c = c + trilinear;  // what the sign along the third multiplies
        const std::array<T, 4> values{low - low_c, high - high_c, low + low_c, high + high_c};
        for (std::size_t line = 0; line < 4; ++line) {
          for (const std::size_t q : detail::lines_along[axis][line]) gradients[q](i, k) = values[line];
        }
      }
    }
    return gradients;
  }

  /// The transpose of `parent_gradients`: what fluxes at the points do to the modes.
  template <class T>
  static Modes<T> parent_divergence(const std::array<Tensor<T>, 8>& flux) {
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
      for (int a = 0; a < 3; ++a) f(3 + a, i) = T(g) * bilinear[static_cast<std::size_t>(a)];
      f(6, i) = T(g * g) * trilinear;
    }
    return f;
  }

  /// Displacement gradients at the Gauss points.
  template <class T>
  static std::array<Tensor<T>, 8> point_gradients(const ElementMotion<T>& motion, const Element<T>& element) {
    auto H = parent_gradients(motion.u);
    for (std::size_t q = 0; q < 8; ++q) H[q] = H[q] * element.inverse_jacobian[q];
    return H;
  }

  template <class T>
  static std::array<T, 8> point_dilatations(const std::array<Tensor<T>, 8>& H) {
    std::array<T, 8> dilatation;
    for (std::size_t q = 0; q < 8; ++q) dilatation[q] = jacobian_minus_one(H[q]);
    return dilatation;
  }
};

}  // namespace sandglass
