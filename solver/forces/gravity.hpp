#pragma once

#include "forces/force_resolver.hpp"

namespace sandglass {

/// The weight of the body and of what is attached to it.
struct Gravity {
  static constexpr std::string_view name = "gravity";
  static constexpr std::string_view summary = "the weight of the body";
  static constexpr std::string_view only_in_motion{};
  static constexpr bool by_mass = true;

  Vector value{};  ///< acceleration at the factor one, m/s^2
  LoadCurve curve = {};

  static constexpr auto parameters() {
    using G = Gravity;
    return std::tuple{
        Parameter{&G::value, "value", "m/s^2", Range::any(), "acceleration"},
        Parameter{&G::curve, "curve", "-", Range::any(),
                  "its factors multiply the load, in place of the loading curve of the case", false}};
  }

  void resolve(ForceResolver& resolver) const;
};

}  // namespace sandglass
