#pragma once

#include "element/hourglass_rate.hpp"
#include "element/perturbation_stiffness.hpp"

namespace sandglass {

/// The stiffness of the perturbation control of Flanagan and Belytschko 1981 in the current configuration:
/// one number for all modes.
struct RatePerturbation : PerturbationStiffness {
  template <class T>
  struct Element {
    T modulus;  ///< kappa (lambda + 2 mu), Pa
  };

  template <class Law>
  static Element<double> precompute(const NodalVectors<double>& /*X*/, const Law& law,
                                    const HourglassSettings& settings) {
    return {modulus(law, settings)};
  }

  template <class T>
  struct Stiffness {
    T k;  ///< N/m

    HourglassModes<T> resistance(const HourglassModes<T>& q) const { return k * q; }
    T energy(const HourglassModes<T>& Q) const { return T(0.5) * double_dot(Q, Q) / k; }
    T bound() const { return k; }
  };

  /// k (N/m) by eq. 12 in the current configuration.
  template <class T>
  static Stiffness<T> stiffness(const Modes<T>& /*x*/, const OnePoint::Element<T>& current,
                                const Element<T>& element) {
    return {PerturbationStiffness::stiffness(element.modulus, current.V, current.h)};
  }
};

using RatePerturbationControl = RateHourglassControl<RatePerturbation>;

}  // namespace sandglass
