#pragma once

#include "element/element_motion.hpp"
#include "element/gram_bound.hpp"
#include "element/perturbation_stiffness.hpp"
#include "mesh/hexahedron.hpp"

namespace sandglass {

/// Perturbation hourglass control of Flanagan and Belytschko in the Total Lagrangian formulation (eq. 2 to
/// eq. 14 of the paper). gamma is orthogonal to linear fields, so rigid motions and uniform strains, however
/// large, cause no force.
struct PerturbationHourglassControl : PerturbationStiffness {
  template <class T>
  struct Element {
    T k;  ///< stiffness of the modes, N/m (eq. 12)
  };
  template <class T>
  using History = NoHistory<T>;

  /// k (eq. 12) of an element with corners X (m): as PerturbationStiffness::stiffness has it, by nodes.
  template <class Law>
  static Element<double> precompute(const NodalVectors<double>& X, const Law& law,
                                    const HourglassSettings& settings) {
    const MeanGradient mean = mean_gradient(X);
    return {modulus(law, settings) * mean.volume * double_dot(mean.h, mean.h) / 8.0};
  }

  /// Hourglass resistances Q = k q (N) to the hourglass displacements q = gamma^T u (m): eq. 4 with both
  /// factors 1/sqrt 8, of eq. 5 and eq. 11, in k.
  template <class T>
  static Matrix<T, 4, 3> resistance(const Matrix<T, 4, 3>& q, const Element<T>& element) {
    return element.k * q;
  }

  /// k/2 |q|^2, in J.
  template <class T>
  static T energy(const Matrix<T, 4, 3>& q, const Element<T>& element) {
    return T(0.5) * element.k * double_dot(q, q);
  }

  /// k lambda_max(gamma^T gamma) in N/m.
  template <class T>
  static T stiffness_bound(const Matrix<T, 8, 4>& gamma, const Element<T>& element) {
    return element.k * shape_vector_bound(gamma);
  }
};

}  // namespace sandglass
