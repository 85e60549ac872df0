#pragma once

#include <string>

#include "forces/force_resolver.hpp"

namespace sandglass {

/// A pressure on the boundary faces within a node set, which follows them as they turn and stretch.
struct Pressure {
  static constexpr std::string_view name = "pressure";
  static constexpr std::string_view summary = "pushes on boundary faces and follows them";
  static constexpr std::string_view only_in_motion{};
  static constexpr bool by_mass = false;

  std::string set;
  double value = 0.0;  ///< at the factor one, Pa
  LoadCurve curve = {};

  static constexpr auto parameters() {
    using P = Pressure;
    return std::tuple{
        Parameter{&P::set, "set", "-", Range::any(), "node set with the loaded faces"},
        Parameter{&P::value, "value", "Pa", Range::any(), "pressure"},
        Parameter{&P::curve, "curve", "-", Range::any(),
                  "its factors multiply the load, in place of the loading curve of the case", false}};
  }

  void resolve(ForceResolver& resolver) const;
};

}  // namespace sandglass
