#pragma once

#include <cmath>

#include "element/element_motion.hpp"
#include "element/hourglass_settings.hpp"
#include "material/laws.hpp"
#include "math/symmetric_matrix.hpp"
#include "mesh/hexahedron.hpp"

namespace sandglass {

/// The stiffness parameter of both forms of the perturbation control, Total and Updated Lagrangian.
struct PerturbationStiffness {
  static constexpr bool active = true;
  static constexpr bool takes_kappa = true;

  /// The modulus that kappa multiplies, Pa: rho c_D^2 = lambda + 2 mu (eq. 9), or mu.
  template <class Law>
  static double kappa_modulus(const Law& law, KappaModulus modulus) {
    const double mu = law.shear_modulus();
    return modulus == KappaModulus::shear ? mu : lame_lambda(law) + 2.0 * mu;
  }

  /// The kappa whose product with its modulus is E/9: with it a cube bends with its exact energy at every
  /// Poisson's ratio. A fixed kappa on lambda + 2 mu locks as nu -> 1/2; on mu the same value varies only
  /// from .278 (nu = .25) to .333.
  template <class Law>
  static double auto_kappa(const Law& law, KappaModulus modulus = KappaModulus::p_wave) {
    return young_modulus(law) / (9.0 * kappa_modulus(law, modulus));
  }

  /// kappa rho c_D^2 (Pa), the material's factor of eq. 12, with either modulus.
  template <class Law>
  static double modulus(const Law& law, const HourglassSettings& settings) {
    const double kappa = settings.kappa.value_or(auto_kappa(law, settings.kappa_modulus));
    return kappa * kappa_modulus(law, settings.kappa_modulus);
  }
};

/// An upper bound of lambda_max(gamma^T gamma): the largest sum of absolute values in a row.
template <class T>
T shape_vector_bound(const Matrix<T, 8, 4>& gamma) {
  return row_sum_bound(transpose(gamma) * gamma);
}

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

  /// k = kappa K_max / 8 (eq. 12) of an element with corners X (m), where K_max = rho V omega^2 / 8 (eq. 6),
  /// omega^2 = c_D^2 g (eq. 7) and g = 8 h_Ii h_Ii (eq. 8); the density cancels.
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

/// f = k gamma gamma^T u (eq. 14) as the paper writes it, two dense products: 360 operations. The kernel,
/// `OnePoint::force`, computes the same with fewer; this form serves tests and the operation count.
template <class T>
NodalVectors<T> paper_hourglass_force(const NodalVectors<T>& u, const Matrix<T, 8, 4>& gamma, const T& k) {
  const Matrix<T, 4, 3> q = transpose(gamma) * u;
  return gamma * (k * q);
}

}  // namespace sandglass
