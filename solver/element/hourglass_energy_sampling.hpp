#pragma once

#include "element/element_motion.hpp"
#include "element/hourglass_fluctuation.hpp"
#include "element/hourglass_settings.hpp"

namespace sandglass {

/// Hourglass control without a parameter, after the energy sampling of Krysl 2015: one point misses the
/// fluctuating part of the energy (mu/2) F : F, whose integral is (1/2) q S q with a constant 4 x 4 matrix S.
/// It does not depend on lambda, so that nothing locks. The isochoric energy of a fluctuation g of the
/// displacement gradient is mu/2 (g : g + tr(g g) - 2/3 (tr g)^2); its mean over all directions of g is 10/9
/// of (mu/2) g : g, hence the factor. The control follows the mean deformation.
struct EnergySamplingControl {
  static constexpr HourglassTraits traits{.follows_deformation = true, .grows_with_deformation = true};

  template <class T>
  struct Element {
    SymmetricMatrix<T, 4> S;  ///< N/m
  };
  template <class T>
  using History = NoHistory<T>;

  /// S_ab = 10/9 mu integral of grad w_a . grad w_b, with w_a the fluctuation due to a unit of q_a.
  template <class Law>
  static Element<double> precompute(const NodalVectors<double>& X, const Law& law,
                                    const HourglassSettings& /*settings*/) {
    const HourglassFluctuation fluctuation = hourglass_fluctuation(X);
    Matrix<double, 4, 4> S{};
    for (std::size_t p = 0; p < 8; ++p) {
      const Matrix<double, 4, 3>& g = fluctuation.gradient[p];
      S += (10.0 / 9.0 * law.shear_modulus() * fluctuation.weight[p]) * (g * transpose(g));
    }
    return {symmetric_part(S)};
  }

  /// Hourglass resistances Q = S q (N).
  template <class T>
  static HourglassModes<T> resistance(const HourglassModes<T>& q, const Element<T>& element) {
    return element.S * q;
  }

  /// gamma S gamma^T has the eigenvalues of S gamma^T gamma, N/m.
  template <class T>
  static T stiffness_bound(const Matrix<T, 8, 4>& gamma, const Element<T>& element) {
    return row_sum_bound(element.S * (transpose(gamma) * gamma));
  }
};

}  // namespace sandglass
