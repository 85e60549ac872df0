#pragma once

#include <array>

#include "element/corner_gradients.hpp"
#include "element/hourglass_none.hpp"
#include "element/one_point.hpp"
#include "element/point_bound.hpp"
#include "material/point_stress.hpp"

namespace sandglass {

/// The average of values at the Gauss points over the element's reference volume.
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

/// One pressure from the element's volume change: Jbar - 1 = (1/V) sum_q w_q (J_q - 1). This is the Q1-P0
/// mixed element with its pressure eliminated.
struct MeanPressure {
  static constexpr bool shared = true;
  template <class T, class Element>
  static std::array<T, 8> dilatations(const std::array<T, 8>& own, const Element& element) {
    std::array<T, 8> mean;
    mean.fill(volume_average(own, element));
    return mean;
  }
};

/// The hexahedron with 2x2x2 Gauss points. `Pressure` is a policy: `PointPressure` gives the displacement
/// element, which locks as nu -> 1/2, and `MeanPressure` the mean-dilatation element. It has no hourglass
/// modes and takes no control.
template <class Pressure>
struct EightPoint {
  /// What is constant in time.
  template <class T>
  struct Element {
    std::array<Tensor<T>, 8>
        inverse_jacobian;     ///< dxi_k/dX_j at the Gauss points, 1/m, times 1/8 because modes are sums
    std::array<T, 8> weight;  ///< det(dX/dxi) at the Gauss points, m^3
    T V;                      ///< reference volume, m^3
  };

  static constexpr KinematicsTraits traits{.points = 8, .averages_pressure = Pressure::shared};
  using NoControl = NoHourglassControl;

  static Element<double> precompute(const NodalVectors<double>& X) { return geometry(to_modes(X)); }

  /// The same from the modes of the nodal coordinates x (m).
  template <class T>
  static Element<T> geometry(const Modes<T>& x) {
    Element<T> element;
    const auto jacobian = parent_gradients(x);  // times 8
    element.V = T(0);
    for (std::size_t q = 0; q < 8; ++q) {
      element.inverse_jacobian[q] = inverse(jacobian[q]);
      element.weight[q] = T(1.0 / 512.0) * determinant(jacobian[q]);
      element.V = element.V + element.weight[q];
    }
    return element;
  }

  /// The deformation at each Gauss point.
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
    std::array<Tensor<T>, 8> flux;  // w P J^-T, the stress conjugate to the parent gradient
    const auto load = [&](std::size_t q) {
      return PointLoad<T>{
          element.weight[q], {now.J_minus_one[q], now.inverse_root[q]}, law.pressure(dilatation[q])};
    };
    for_each_stress(law, now.H, load, [&](std::size_t q, const Tensor<T>& VP) {
      flux[q] = VP * transpose(element.inverse_jacobian[q]);
    });
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
      W = W + element.weight[q] *
                  (at_point(law, q).isochoric_energy(H[q]) + law.volumetric_energy(dilatation[q]));
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
  static T dilatation(const ElementMotion<T>& motion, const Element<T>& element) {
    return volume_average(point_dilatations(point_gradients(motion, element)), element);
  }

  /// An upper bound of the largest eigenvalue (N/m) of the tangent stiffness.
  template <class Hourglass, class T, class Law>
  static T stiffness_bound(const ElementMotion<T>& motion, const Element<T>& element,
                           const NoControl::Element<T>& /*control*/, const NoHistory<T>& /*history*/,
                           const Law& law) {
    const auto H = point_gradients(motion, element);
    const auto dilatation = Pressure::dilatations(point_dilatations(H), element);
    const auto places = gauss_points();
    const auto spatial_gradient = [&](std::size_t q) {
      const Tensor<T> to_space = T(8) * (element.inverse_jacobian[q] * inverse(identity<T>() + H[q]));
      return from_double<T>(parent_gradient(places[q])) * to_space;
    };
    return point_bound<Pressure::shared>(H, dilatation, element.weight, element.V, spatial_gradient, law);
  }

 private:
  static constexpr double g = gauss_coordinate;

  /// The Gauss points, at +-g along each axis.
  struct AtGaussPoints {
    template <class T>
    static T bilinear(const T& mode) {
      return T(g) * mode;
    }
    template <class T>
    static T trilinear(const T& mode) {
      return T(g * g) * mode;
    }
  };

  /// Parent gradients du_i/dxi_k at the Gauss points, times 8.
  template <class T>
  static std::array<Tensor<T>, 8> parent_gradients(const Modes<T>& modes) {
    return corner_gradients<AtGaussPoints>(modes);
  }

  /// The transpose of `parent_gradients`: modal forces of fluxes at the points.
  template <class T>
  static Modes<T> parent_divergence(const std::array<Tensor<T>, 8>& flux) {
    return corner_divergence<AtGaussPoints>(flux);
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
