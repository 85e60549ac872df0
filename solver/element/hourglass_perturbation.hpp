#pragma once

#include <cmath>

#include "element/element_motion.hpp"
#include "element/hourglass_settings.hpp"
#include "material/laws.hpp"
#include "math/symmetric_matrix.hpp"
#include "mesh/hexahedron.hpp"

namespace sandglass {

/// The stiffness parameter that both forms of the perturbation control take.
struct PerturbationStiffness {
  static constexpr bool active = true;
  static constexpr bool takes_kappa = true;

  /// The modulus that kappa multiplies, Pa: rho c_D^2 = lambda + 2 mu (eq. 9), or mu.
  template <class Law>
  static double kappa_modulus(const Law& law, KappaModulus modulus) {
    const double mu = law.shear_modulus();
    return modulus == KappaModulus::shear ? mu : lame_lambda(law) + 2.0 * mu;
  }

  /// kappa times its modulus = E/9: with it a cube bends with its exact energy at every Poisson's ratio. A
  /// fixed kappa on lambda + 2 mu locks as nu -> 1/2; on mu it may stay between .278 (nu = .25) and .333.
  template <class Law>
  static double auto_kappa(const Law& law, KappaModulus modulus = KappaModulus::p_wave) {
    return young_modulus(law) / (9.0 * kappa_modulus(law, modulus));
  }

  /// kappa rho c_D^2 in Pa (eqs 9 and 12), with either modulus.
  template <class Law>
  static double modulus(const Law& law, const HourglassSettings& settings) {
    const double kappa = settings.kappa.value_or(auto_kappa(law, settings.kappa_modulus));
    return kappa * kappa_modulus(law, settings.kappa_modulus);
  }
};

/// lambda_max(gamma^T gamma), bounded by the largest sum of absolute values in a row.
template <class T>
T shape_vector_bound(const Matrix<T, 8, 4>& gamma) {
  return row_sum_bound(transpose(gamma) * gamma);
}

/// Perturbation hourglass control of Flanagan and Belytschko in the Total Lagrangian formulation (paper, eqs
/// 2-14). gamma is orthogonal to linear fields, so rigid motions and uniform strains feel no force, however
/// large.
struct PerturbationHourglassControl : PerturbationStiffness {
  template <class T>
  struct Element {
    T k;  ///< stiffness of the modes, N/m (eq. 12)
  };
  template <class T>
  using History = NoHistory<T>;

  template <class Law>
  static Element<double> precompute(const NodalVectors<double>& X, const Law& law,
                                    const HourglassSettings& settings) {
    const MeanGradient mean = mean_gradient(X);
    return {modulus(law, settings) * mean.volume * double_dot(mean.h, mean.h) / 8.0};  // eqs 6-8
  }

  /// Hourglass resistances Q = k q (N) to the hourglass displacements q = gamma^T u (m); eqs 4, 11 and 12.
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

/// f = k gamma gamma^T u (eq. 14) as the paper writes it, two dense products: 360 operations. The kernel
/// computes the same with fewer; this form stays for tests and for the count of operations.
template <class T>
NodalVectors<T> paper_hourglass_force(const NodalVectors<T>& u, const Matrix<T, 8, 4>& gamma, const T& k) {
  const Matrix<T, 4, 3> q = transpose(gamma) * u;
  return gamma * (k * q);
}

}  // namespace sandglass
