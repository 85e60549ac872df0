#pragma once

#include <cmath>

#include "element/element_motion.hpp"
#include "element/gram_bound.hpp"
#include "element/hourglass_settings.hpp"
#include "element/updated_one_point.hpp"

namespace sandglass {

/// Viscous hourglass control, the default of LS-DYNA and OpenRadioss in the form that is exact on distorted
/// elements (LS-DYNA's type 3): Q = c gamma^T v with the shape vectors of Flanagan and Belytschko 1981 and
///   c = kappa / 4 rho c_d v^(2/3),   rho and v of the current configuration, c_d of the undeformed one.
/// It damps hourglass velocities and does not affect affine motions, rotations included. It stores no energy;
/// the work done on it is dissipated. In quasi-static runs it gives no force, and bodies hourglass as without
/// control.
///
/// It has no Total Lagrangian counterpart. With reference shape vectors c would be constant and affine
/// motions free of force, but not the rotation of a bent element: its velocity Omega x is linear in x, not in
/// X, so that gamma^T v = Omega q is not zero, and spinning bodies would be braked. The rate that is
/// invariant under rotation, d(F^-1 q)/dt, requires the gradients of the increment, F^-1, and the reaction on
/// the mean stress.
///
/// kappa is the dimensionless coefficient, QM in LS-DYNA and h in OpenRadioss; `auto` is the default of both,
/// 0.1.
struct ViscousHourglassControl {
  static constexpr HourglassTraits traits{.takes_kappa = true, .damps_only = true};

  template <class T>
  struct Element {
    T impedance;  ///< kappa / 4 rho c_d of the undeformed state, Pa s/m
    T modulus;    ///< kappa^2 (lambda + 2 mu) = (4 impedance)^2 / rho, Pa: for the stable step
  };
  template <class T>
  using History = NoHistory<T>;

  template <class Law>
  static double auto_kappa(const Law& /*law*/, KappaModulus /*modulus*/ = KappaModulus::p_wave) {
    return 0.1;
  }

  template <class Law>
  static Element<double> precompute(const NodalVectors<double>& /*X*/, const Law& law,
                                    const HourglassSettings& settings) {
    const double kappa = settings.kappa.value_or(auto_kappa(law));
    const double M = lame_lambda(law) + 2.0 * law.shear_modulus();
    return {0.25 * kappa * std::sqrt(settings.density * M), kappa * kappa * M};
  }

  /// c gamma^T v, with rho v^(2/3) = rho_0 V_0 v^(-1/3).
  template <class T>
  static HourglassModes<T> resistance(const UpdatedOnePoint::Deformation<T>& now, const Element<T>& element,
                                      NoHistory<T>& /*history*/) {
    const T c = element.impedance * UpdatedOnePoint::reference_volume(now) * inverse_cube_root(now.current.V);
    return (c * now.inverse_step) * now.rate;
  }

  /// Zero: nothing is stored.
  template <class T>
  static T energy(const UpdatedOnePoint::Deformation<T>& /*now*/, const Element<T>& /*element*/,
                  const NoHistory<T>& /*history*/) {
    return T(0);
  }

  /// Damping shortens the stable step. Velocities are half a step behind, so that an eigenvector of the
  /// scheme with Rayleigh quotients m, d and k of mass, damping and stiffness obeys
  ///   m z^2 - (2 m - dt d - dt^2 k) z + (m - dt d) = 0,
  /// which leaves the unit circle through z = -1 when dt^2 k + 2 dt d = 4 m: the familiar
  /// dt = (2 / omega) (sqrt(1 + xi^2) - xi). The stiffness that has this dt without damping is
  ///   (sqrt(a) + sqrt(a + k))^2,   a = d^2 / (4 m),  d = c lambda_max(gamma^T gamma),  m = rho V_0 / 8,
  /// and the density cancels in a.
  template <class T>
  static T stiffness_bound(const T& body, const Matrix<T, 8, 4>& gamma,
                           const UpdatedOnePoint::Deformation<T>& now, const Element<T>& element,
                           const NoHistory<T>& /*history*/) {
    const T shape = shape_vector_bound(gamma);
    const T root = inverse_cube_root(now.current.V);
    const T a =
        T(0.125) * element.modulus * UpdatedOnePoint::reference_volume(now) * (root * root) * (shape * shape);
    const T sum = sqrt(a) + sqrt(a + body);
    return sum * sum;
  }
};

}  // namespace sandglass
