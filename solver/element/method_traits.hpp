#pragma once

#include <string_view>
#include <vector>

#include "base/type_list.hpp"
#include "element/formulation.hpp"

/// What is asked of a method when it is compiled. Each says in a header of `element/methods/`: name, summary,
/// integration_points, Kinematics and Hourglass; where it has them also `zero_energy_modes`, the modes that
/// are left without energy by nature; `condensed`; `Levels`, methods from the cheapest to the one that an
/// adaptive method stands for; `AtSmallStrain`, what an Updated Lagrangian method tends to as strains vanish
/// and time plays no part; `SharesKernelsOf`, a method with the same element.
namespace sandglass {

/// An hourglass control that resists velocities alone says so with `damps_only`: it loses energy, and does
/// nothing where time plays no part.
template <class Hourglass>
concept DampsOnly = requires {
  requires Hourglass::damps_only;
};

/// Whether the strength of a method's hourglass control matters to a body at rest.
template <class Method>
inline constexpr bool kappa_affects_equilibrium =
    Method::Hourglass::takes_kappa && !DampsOnly<typename Method::Hourglass>;

/// Whether a method's forces are linear in the displacements, f = K u.
template <class Method>
inline constexpr bool is_linear = requires {
  requires Method::Kinematics::small_strain;
};

/// Whether a method takes no steps: its answers are superposed from responses that are computed once.
template <class Method>
inline constexpr bool is_condensed = requires {
  requires Method::condensed;
};

/// Whether a method's elements change the way they integrate.
template <class Method>
inline constexpr bool is_adaptive = requires {
  typename Method::Levels;
};

namespace detail {

template <class Method>
struct KernelOwner {
  using type = Method;
};
template <class Method>
requires requires {
  typename Method::SharesKernelsOf;
}
struct KernelOwner<Method> {
  using type = typename Method::SharesKernelsOf;
};

template <class Method>
struct LevelsOf {
  using type = TypeList<Method>;
};
template <class Method>
requires is_adaptive<Method>
struct LevelsOf<Method> {
  using type = typename Method::Levels;
};

}  // namespace detail

/// The method whose kernels a method runs: itself, unless it `SharesKernelsOf` another.
template <class Method>
using KernelOwner = typename detail::KernelOwner<Method>::type;

/// The levels of a method's elements; of one that does not adapt, itself.
template <class Method>
using LevelsOf = typename detail::LevelsOf<Method>::type;

/// The names of an adaptive method's levels, from the cheapest on; none for other methods.
template <class Method>
std::vector<std::string_view> level_names() {
  std::vector<std::string_view> names;
  if constexpr (is_adaptive<Method>) {
    for_each_type(typename Method::Levels{}, [&]<class Level>() { names.push_back(Level::name); });
  }
  return names;
}

/// Whether a method knows what to do with a law: small-strain theory takes a law's moduli at rest, and would
/// forget that it relaxes; what an element remembers at one point says nothing of eight.
template <class Method, class Law>
inline constexpr bool knows_law = !((is_linear<Method> || is_adaptive<Method>)&&law_remembers<Law>);

/// A method with a law: the element that the assembly runs.
template <class Method, class Law>
using FormulationOf = Formulation<typename Method::Kinematics, typename Method::Hourglass, Law>;

}  // namespace sandglass
