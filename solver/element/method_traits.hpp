#pragma once

#include <string_view>
#include <type_traits>
#include <vector>

#include "base/type_list.hpp"
#include "element/formulation.hpp"
#include "element/method.hpp"

/// Properties of methods at compile time, from their options (method.hpp) and the traits of their elements.
namespace sandglass {

/// Whether an hourglass control resists only velocities: it dissipates energy and gives no force in
/// quasi-static runs.
template <class Hourglass>
concept DampsOnly = Hourglass::traits.damps_only;

/// Whether the strength of a method's hourglass control affects a body in equilibrium.
template <class Method>
inline constexpr bool kappa_affects_equilibrium =
    Method::Hourglass::traits.takes_kappa && !DampsOnly<typename Method::Hourglass>;

/// The number of integration points of a method's elements; of an adaptive one those of the lowest level.
template <class Method>
inline constexpr int integration_points = Method::Kinematics::traits.points;

/// Whether a method resists volume changes at several points of an element or around its nodes, and not their
/// average by one pressure.
template <class Method>
inline constexpr bool pressure_varies = integration_points<Method> > 1 &&
                                        (!Method::Kinematics::traits.averages_pressure ||
                                         Method::Kinematics::traits.averages_over_nodes);

/// Whether a method's forces are linear in the displacements, f = K u.
template <class Method>
inline constexpr bool is_linear = Method::Kinematics::traits.small_strain;

/// Whether a method superposes its answers from responses that are computed once, instead of taking steps.
template <class Method>
inline constexpr bool is_condensed = states<Method, Condensed>;

/// Whether a method computes bodies side by side; see BatchForce.
template <class Method>
inline constexpr bool batches = states<Method, Batches>;

namespace detail {

template <class Method>
struct KernelOwner {
  using type = Method;
};
template <class Method>
requires requires {
  typename Method::Owner;
}
struct KernelOwner<Method> {
  using type = typename Method::Owner;
};

template <class Method>
struct RegularForm {
  using type = Method;
};
template <class Method>
requires requires {
  typename Method::RegularKinematics;
}
struct RegularForm<Method> {
  struct Form : Method {
    using Kinematics = typename Method::RegularKinematics;
  };
  using type = Form;
};

template <class Method>
struct LevelsOf {
  using type = TypeList<Method>;
};
template <class Method>
requires requires {
  typename Method::Levels;
}
struct LevelsOf<Method> {
  using type = typename Method::Levels;
};

}  // namespace detail

/// The method whose kernels a method uses: itself, unless it states `SharesKernelsOf`.
template <class Method>
using KernelOwner = typename detail::KernelOwner<Method>::type;

/// The form of a method for meshes of parallelepipeds: itself, unless it states `OnParallelepipedsBy`.
template <class Method>
using OnParallelepipeds = typename detail::RegularForm<Method>::type;

/// The levels of a method's elements; for a method that is not adaptive, the method itself.
template <class Method>
using LevelsOf = typename detail::LevelsOf<Method>::type;

/// Whether a method chooses a level for each of its elements.
template <class Method>
inline constexpr bool is_adaptive = !std::is_same_v<LevelsOf<Method>, TypeList<Method>>;

/// The names of an adaptive method's levels, from the cheapest on; none for other methods.
template <class Method>
std::vector<std::string_view> level_names() {
  std::vector<std::string_view> names;
  if constexpr (is_adaptive<Method>) {
    for_each_type(typename Method::Levels{}, [&]<class Level>() { names.push_back(Level::name); });
  }
  return names;
}

/// Whether a method supports a law. Laws with memory are not supported by small-strain theory, which takes
/// only a law's initial moduli, nor by adaptive methods, where a memory at one point does not determine
/// eight.
template <class Method, class Law>
inline constexpr bool knows_law = !((is_linear<Method> || is_adaptive<Method>)&&law_remembers<Law>);

/// The element of a method with a law.
template <class Method, class Law>
using FormulationOf = Formulation<typename Method::Kinematics, typename Method::Hourglass, Law>;

}  // namespace sandglass
