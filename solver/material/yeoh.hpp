#pragma once

#include <cmath>
#include <optional>
#include <string_view>
#include <tuple>

#include "base/parameter.hpp"
#include "material/first_invariant.hpp"

namespace sandglass {

/// The law of Yeoh (Rubber Chemistry and Technology 66, 1993, 754-771) with the isochoric first invariant,
///   W = c1 x + c2 x^2 + c3 x^3 + K/2 (J - 1)^2,  x = J^(-2/3) tr(F^T F) - 3.
/// With c2 < 0 < c3 it softens first and stiffens later, as rubber and many tissues do.
template <class Value>
struct YeohOf : FirstInvariant<YeohOf<Value>> {
  static constexpr std::string_view name = "yeoh";
  static constexpr std::string_view summary =
      "cubic in the isochoric first invariant: softens, then stiffens";

  Value c1 = 0.0;
  Value c2 = 0.0;
  Value c3 = 0.0;
  Value bulk = 0.0;

  static constexpr auto parameters() {
    return std::tuple{
        Parameter{&YeohOf::c1, "c1", "Pa", Range::positive(), "half of the initial shear modulus"},
        Parameter{&YeohOf::c2, "c2", "Pa", Range::any(), "factor of the first invariant squared"},
        Parameter{&YeohOf::c3, "c3", "Pa", Range::at_least(0.0), "factor of the first invariant cubed"},
        Parameter{&YeohOf::bulk, "bulk_modulus", "Pa", Range::positive(), "initial bulk modulus"}};
  }

  /// c1 + 2 c2 x + 3 c3 x^2, a quarter of the shear modulus at x, stays positive for all x > 0.
  std::optional<BrokenRule> broken_rule() const {
    if (c2 >= 0.0 || c2 * c2 < 3.0 * c1 * c3) return std::nullopt;
    return BrokenRule{"c2", fmt::format("= {} must be at least 0, or c2^2 less than 3 c1 c3 = {}: the shear "
                                        "modulus would become negative under stretch",
                                        c2, 3.0 * c1 * c3)};
  }

  constexpr Value shear_modulus() const { return 2.0 * c1; }
  constexpr Value bulk_modulus() const { return bulk; }

  /// c1 x + c2 x^2 + c3 x^3, in J/m^3.
  template <class T>
  T isochoric_energy(const Tensor<T>& H) const {
    const T x = T(3) * third_of_first_invariant_growth(H);
    return x * (T(c1) + x * (T(c2) + x * T(c3)));
  }

  /// The shear modulus at this strain, Pa.
  template <class T>
  T current_modulus(const Tensor<T>& H, const VolumeChange<T>& change) const {
    return modulus(first_invariant_growth(H, change));
  }

  /// Bound of the isochoric tangent; see TangentBound.
  template <class T>
  TangentBound<T> isochoric_tangent_bound(const Tensor<T>& H) const {
    const T x = first_invariant_growth(H, volume_change(H));
    return first_invariant_tangent_bound(modulus(x), T(2.0 * c2) + T(6.0 * c3) * x, H);
  }

 private:
  /// The shear modulus at x, 2 w'(x).
  template <class T>
  T modulus(const T& x) const {
    return T(2.0 * c1) + x * (T(4.0 * c2) + x * T(6.0 * c3));
  }
};

using Yeoh = YeohOf<double>;

}  // namespace sandglass
