#pragma once

#include <array>
#include <string>

#include "forces/force_resolver.hpp"

namespace sandglass {

/// A dead load on the boundary faces within a node set, or on its nodes.
struct DeadForce {
  static constexpr std::string_view name = "force";
  static constexpr std::string_view summary = "a dead load, which keeps its direction";
  static constexpr std::string_view only_in_motion{};
  static constexpr bool by_mass = false;
  static constexpr std::array<std::string_view, 2> one_of{"total", "moment"};

  /// Faces carry the total as a uniform traction; nodes carry equal shares.
  enum class Carrier { faces, nodes };
  friend constexpr std::array<std::string_view, 2> words_of(Carrier /*type*/) { return {"faces", "nodes"}; }

  std::string set;
  Vector total{};   ///< sum at the factor one, N
  Vector moment{};  ///< about the centroid of the faces, N m
  Carrier on = Carrier::faces;
  LoadCurve curve = {};

  static constexpr auto parameters() {
    using F = DeadForce;
    return std::tuple{
        Parameter{&F::set, "set", "-", Range::any(), "node set on which it acts"},
        Parameter{&F::total, "total", "N", Range::any(), "total force", false},
        Parameter{&F::moment, "moment", "N m", Range::any(), "moment about the centroid of the faces", false},
        Parameter{&F::curve, "curve", "-", Range::any(),
                  "its factors multiply the load, in place of the loading curve of the case", false},
        Parameter{&F::on, "on", "-", Range::any(),
                  "the boundary faces within the set, or its nodes, which share the total equally", false}};
  }
  std::optional<BrokenRule> broken_rule() const;

  void resolve(ForceResolver& resolver) const;
};

}  // namespace sandglass
