#pragma once

#include "element/one_point.hpp"

namespace sandglass {

/// Average over the element's reference volume of values at its Gauss points.
template <class T, class Element>
T volume_average(const std::array<T, 8>& values, const Element& element) {
  T sum = element.weight[0] * values[0];
  for (std::size_t q = 1; q < 8; ++q) sum = sum + element.weight[q] * values[q];
  return sum / element.V;
}

/// The hexahedron with 2x2x2 Gauss points. Pressure is a policy: `PointPressure` gives the displacement
/// element, which locks as nu -> 1/2; `MeanPressure` the mean-dilatation element, the explicit twin of the
/// mixed Q1-P0 element.
template <class Pressure>
struct EightPoint {
  template <class T>
  struct Element {
    std::array<NodalVectors<T>, 8> gradient;  ///< dN_I/dX_i at the Gauss points, 1/m
    std::array<T, 8> weight;                  ///< det(dX/dxi) at the Gauss points, m^3
    NodalVectors<T> h;                        ///< mean shape gradients, 1/m
    T V;                                      ///< reference volume, m^3
  };

  static Element<double> precompute(const NodalVectors<double>& X) {
    Element<double> element{};
    const auto points = gauss_points();
    for (std::size_t q = 0; q < 8; ++q) {
      const PointGradient point = point_gradient(X, points[q]);
      element.gradient[q] = point.gradient;
      element.weight[q] = point.measure;
    }
    const MeanGradient mean = sandglass::mean_gradient(X);
    element.h = mean.h;
    element.V = mean.volume;
    return element;
  }

  template <class T>
  static Tensor<T> mean_gradient(const NodalVectors<T>& u, const Element<T>& element) {
    return transpose(u) * element.h;
  }

  /// Internal nodal forces (N): sum_q w_q B_q (P_iso(H_q) + p_q cof F_q)^T.
  template <class T, class Law>
  static NodalVectors<T> force(const NodalVectors<T>& u, const Tensor<T>& /*H*/, const Element<T>& element,
                               const Law& law) {
    const auto dilatation = Pressure::dilatations(point_dilatations(u, element), element);
    NodalVectors<T> f;
    for (std::size_t q = 0; q < 8; ++q) {
      const Tensor<T> H = point_gradient_of(u, element, q);
      const Tensor<T> P = law.isochoric_piola(H) + law.pressure(dilatation[q]) * cofactor(identity<T>() + H);
      f += element.gradient[q] * (element.weight[q] * transpose(P));
    }
    return f;
  }

  /// Strain energy (J).
  template <class T, class Law>
  static T energy(const NodalVectors<T>& u, const Tensor<T>& /*H*/, const Element<T>& element,
                  const Law& law) {
    const auto dilatation = Pressure::dilatations(point_dilatations(u, element), element);
    T W = T(0);
    for (std::size_t q = 0; q < 8; ++q) {
      const Tensor<T> H = point_gradient_of(u, element, q);
      W = W + element.weight[q] * (law.isochoric_energy(H) + law.volumetric_energy(dilatation[q]));
    }
    return W;
  }

  template <class T>
  static T smallest_jacobian(const NodalVectors<T>& u, const Tensor<T>& /*H*/, const Element<T>& element) {
    const auto dilatation = point_dilatations(u, element);
    T smallest = dilatation[0];
    for (std::size_t q = 1; q < 8; ++q) smallest = min(smallest, dilatation[q]);
    return T(1) + smallest;
  }

  template <class T>
  static T mean_jacobian(const NodalVectors<T>& u, const Tensor<T>& /*H*/, const Element<T>& element) {
    return T(1) + volume_average(point_dilatations(u, element), element);
  }

  /// An upper bound of the largest eigenvalue (N/m) of the tangent stiffness at u: the points' bounds add up,
  /// and the stiffness of a pressure that is one for the element acts on one mean spatial gradient.
  template <class T, class Law>
  static T stiffness_bound(const NodalVectors<T>& u, const Tensor<T>& /*H*/, const Element<T>& element,
                           const Law& law) {
    const auto own_dilatation = point_dilatations(u, element);
    const auto dilatation = Pressure::dilatations(own_dilatation, element);
    T bound = T(0);
    NodalVectors<T> mean_spatial_gradient;
    for (std::size_t q = 0; q < 8; ++q) {
      const Tensor<T> H = point_gradient_of(u, element, q);
      const NodalVectors<T> g = element.gradient[q] * inverse(identity<T>() + H);
      const T J = T(1) + own_dilatation[q];
      const T bulk = Pressure::shared ? T(0) : law.bulk_tangent(dilatation[q]);
      const auto vol = volumetric_tangent_bound(J, law.pressure(dilatation[q]), bulk);
      const auto iso = law.isochoric_tangent_bound(H);
      const TangentBound<T> point{iso.volumetric + vol.volumetric, iso.gradient + vol.gradient};
      bound = bound + element.weight[q] * OnePoint::gradient_bound(point, g);
      mean_spatial_gradient += (element.weight[q] * J / element.V) * g;
    }
    if constexpr (Pressure::shared) {
      bound = bound + element.V * law.bulk_tangent(dilatation[0]) *
                          double_dot(mean_spatial_gradient, mean_spatial_gradient);
    }
    return bound;
  }

 private:
  template <class T>
  static Tensor<T> point_gradient_of(const NodalVectors<T>& u, const Element<T>& element, std::size_t q) {
    return transpose(u) * element.gradient[q];
  }

  template <class T>
  static std::array<T, 8> point_dilatations(const NodalVectors<T>& u, const Element<T>& element) {
    std::array<T, 8> dilatation;
    for (std::size_t q = 0; q < 8; ++q) dilatation[q] = jacobian_minus_one(point_gradient_of(u, element, q));
    return dilatation;
  }
};

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

}  // namespace sandglass
