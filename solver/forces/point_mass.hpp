#pragma once

#include <string>

#include "forces/force_resolver.hpp"

namespace sandglass {

/// A mass that is attached to nodes: it has inertia and, under [[gravity]], weight.
struct PointMass {
  static constexpr std::string_view name = "mass";
  static constexpr std::string_view summary =
      "a mass attached to nodes in equal shares: inertia in motion, weight under [[gravity]]";
  static constexpr std::string_view only_in_motion{};
  static constexpr bool by_mass = false;

  std::string set;
  double total = 0.0;  ///< kg

  static constexpr auto parameters() {
    using M = PointMass;
    return std::tuple{Parameter{&M::set, "set", "-", Range::any(), "node set to which it is attached"},
                      Parameter{&M::total, "total", "kg", Range::at_least(0.0), "sum over the nodes"}};
  }

  void resolve(ForceResolver& resolver) const;
};

}  // namespace sandglass
