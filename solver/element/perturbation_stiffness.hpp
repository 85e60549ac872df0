#pragma once

#include "element/hourglass_settings.hpp"
#include "material/laws.hpp"
#include "math/matrix.hpp"

namespace sandglass {

/// The stiffness parameter of both forms of the perturbation control, Total and Updated Lagrangian.
struct PerturbationStiffness {
  static constexpr HourglassTraits traits{.takes_kappa = true};

  /// The modulus that kappa multiplies, Pa: rho c_D^2 = lambda + 2 mu (eq. 9), or mu.
  template <class Law>
  static double kappa_modulus(const Law& law, KappaModulus modulus) {
    const double mu = law.shear_modulus();
    return modulus == KappaModulus::shear ? mu : lame_lambda(law) + 2.0 * mu;
  }

  /// The kappa whose product with its modulus is E/9: with it a cube bends with its exact energy at every
  /// Poisson's ratio. A fixed kappa on lambda + 2 mu locks as nu -> 1/2; on mu the same value varies only
  /// from 0.278 (nu = 0.25) to 0.333.
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

  /// k = kappa K_max / 8 (N/m, eq. 12) from this modulus and the volume V (m^3) and mean gradients h (1/m) of
  /// an element, where K_max = rho V omega^2 / 8 (eq. 6), omega^2 = c_D^2 g (eq. 7) and g = 8 h_Ii h_Ii
  /// (eq. 8); the density cancels. The h are those of the modes: h_Ii h_Ii by nodes is eight times as much.
  template <class T>
  static T stiffness(const T& modulus, const T& V, const Matrix<T, 6, 3>& h) {
    return modulus * V * double_dot(h, h);
  }
};

}  // namespace sandglass
