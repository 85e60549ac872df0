#pragma once

#include <string>

#include "forces/force_resolver.hpp"

namespace sandglass {

/// Springs and dashpots between the boundary faces within a node set and their undeformed positions (Robin's
/// condition).
struct Support {
  static constexpr std::string_view name = "support";
  static constexpr std::string_view summary =
      "springs and dashpots between boundary faces and their undeformed positions";
  static constexpr std::string_view only_in_motion = "damping";
  static constexpr bool by_mass = false;

  std::string set;
  double stiffness = 0.0;    ///< Pa/m, per area
  double damping = 0.0;      ///< Pa s/m, per area; not used in static answers
  bool only_normal = false;  ///< resist only motion along the normal of the undeformed face

  static constexpr auto parameters() {
    using S = Support;
    return std::tuple{Parameter{&S::set, "set", "-", Range::any(), "node set with the held faces"},
                      Parameter{&S::stiffness, "stiffness", "Pa/m", Range::at_least(0.0),
                                "stiffness of the springs, per area", false},
                      Parameter{&S::damping, "damping", "Pa s/m", Range::at_least(0.0),
                                "damping of the dashpots, per area", false},
                      Parameter{&S::only_normal, "only_normal", "-", Range::any(),
                                "whether they resist only motion along the undeformed normal", false}};
  }
  std::optional<BrokenRule> broken_rule() const;

  void resolve(ForceResolver& resolver) const;
};

}  // namespace sandglass
