#pragma once

#include <string_view>
#include <tuple>

#include "base/parameter.hpp"
#include "material/first_invariant.hpp"

namespace sandglass {

/// The nearly incompressible neo-Hookean law of ABAQUS and of the TLED paper,
///   W = mu/2 (J^(-2/3) tr(F^T F) - 3) + K/2 (J - 1)^2,
/// written in the displacement gradient H = F - I, so that nothing cancels near the undeformed state.
/// Energies in J/m^3, stresses in Pa, per reference volume.
template <class Value>
struct NeoHookeanOf : FirstInvariant<NeoHookeanOf<Value>> {
  static constexpr std::string_view name = "neo-hookean";
  static constexpr std::string_view summary = "isochoric neo-Hookean with a quadratic volumetric energy";

  Value young_modulus = 0.0;
  Value poisson_ratio = 0.0;

  static constexpr auto parameters() {
    return std::tuple{Parameter{&NeoHookeanOf::young_modulus, "young_modulus", "Pa", Range::positive(),
                                "initial Young's modulus"},
                      Parameter{&NeoHookeanOf::poisson_ratio, "poisson_ratio", "-", Range::between(-1.0, 0.5),
                                "initial Poisson's ratio"}};
  }

  constexpr Value shear_modulus() const { return young_modulus / 2.0 / (1.0 + poisson_ratio); }
  constexpr Value bulk_modulus() const { return young_modulus / 3.0 / (1.0 - 2.0 * poisson_ratio); }

  /// mu/2 (J^(-2/3) tr(F^T F) - 3), in J/m^3.
  template <class T>
  T isochoric_energy(const Tensor<T>& H) const {
    return T(1.5 * shear_modulus()) * third_of_first_invariant_growth(H);
  }

  /// The shear modulus, the same at all strains, Pa.
  template <class T>
  T current_modulus(const Tensor<T>& /*H*/, const VolumeChange<T>& /*change*/) const {
    return T(shear_modulus());
  }

  /// Bound of the isochoric tangent in the current configuration; see TangentBound.
  template <class T>
  TangentBound<T> isochoric_tangent_bound(const Tensor<T>& H) const {
    return first_invariant_tangent_bound(T(shear_modulus()), H);
  }
};

using NeoHookean = NeoHookeanOf<double>;

}  // namespace sandglass
