#pragma once

#include <array>
#include <string>

#include "forces/force_resolver.hpp"

namespace sandglass {

/// Two surfaces of deformable bodies, or one with itself, that push each other away where they touch. The
/// pressure of a penalty acts on undeformed areas.
struct Contact {
  static constexpr std::string_view name = "contact";
  static constexpr std::string_view summary = "two surfaces that may touch, or one that may touch itself";
  static constexpr std::string_view only_in_motion{};
  static constexpr bool by_mass = false;
  static constexpr std::array<std::string_view, 2> numerical{"penalty", "method"};

  /// Kinematic: in every step, nodes are moved apart. Penalty: a force in proportion to the depth.
  enum class Method { kinematic, penalty };
  friend constexpr std::array<std::string_view, 2> words_of(Method /*type*/) {
    return {"kinematic", "penalty"};
  }

  std::string label;
  std::string set;
  std::string other;      ///< empty: the surface touches itself
  double friction = 0.0;  ///< Coulomb's coefficient
  LoadCurve curve = {};   ///< of the friction; without one it is constant
  double penalty = 30.0;  ///< see parameters
  Method method = Method::kinematic;

  static constexpr auto parameters() {
    using C = Contact;
    return std::tuple{
        Parameter{&C::label, "name", "-", Range::any(),
                  "under which the force on the first surface is reported"},
        Parameter{&C::set, "set", "-", Range::any(), "node set with the boundary faces of the first surface"},
        Parameter{&C::other, "other", "-", Range::any(),
                  "node set of the second surface; without it, the first may touch itself", false},
        Parameter{&C::friction, "friction", "-", Range::at_least(0.0), "Coulomb's coefficient", false},
        Parameter{
            &C::curve, "curve", "-", Range::any(),
            "its factors multiply the friction and must not be negative; without a curve, it is constant",
            false},
        Parameter{&C::penalty, "penalty", "-", Range::positive(),
                  "pressure over E depth / h, with the smallest Young's modulus E and the shortest edge h of "
                  "the elements at both surfaces",
                  false},
        Parameter{&C::method, "method", "-", Range::any(),
                  "kinematic moves nodes apart in steps as long as without contact; penalty pushes them, in "
                  "shorter steps, and loses energy by friction alone; static equilibrium takes the penalty",
                  false}};
  }
  std::optional<BrokenRule> broken_rule() const;

  void resolve(ForceResolver& resolver) const;
};

}  // namespace sandglass
