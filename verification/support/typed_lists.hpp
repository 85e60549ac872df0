#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <string>

#include "element/methods.hpp"
#include "material/laws.hpp"
#include "mesh/generators.hpp"
#include "support/nodal_form.hpp"

/// Turns the solver's lists into typed tests, so that a new method, law or generator is tested without an
/// edit.
namespace sandglass::verification {

/// One pair of the product method x law.
template <class MethodType, class LawType>
struct MethodWithLaw {
  using Method = MethodType;
  using Law = LawType;
  using Kernel = FormulationOf<Method, Law>;
  static std::string label() { return std::string(Method::name) + " " + std::string(Law::name); }
};

/// A pair whose force follows from the displacements of one element, so that it can be tested alone.
template <class MethodType, class LawType>
struct ElasticMethodWithLaw : MethodWithLaw<MethodType, LawType> {
  using Formulation = NodalForm<FormulationOf<MethodType, LawType>>;
};

namespace detail {

/// A list of the first entry alone, and one of the others.
template <class List>
struct Split;
template <class First, class... Others>
struct Split<TypeList<First, Others...>> {
  using first = TypeList<First>;
  using others = TypeList<Others...>;
};

template <class List>
struct AsTestTypes;
template <class... Entries>
struct AsTestTypes<TypeList<Entries...>> {
  using type = ::testing::Types<Entries...>;
};

template <class Method, class LawList>
struct WithEveryLaw;
template <class Method, class... EveryLaw>
struct WithEveryLaw<Method, TypeList<EveryLaw...>> {
  using type = TypeList<MethodWithLaw<Method, EveryLaw>...>;
};

template <class MethodList, class LawList>
struct Product;
template <class... EveryMethod, class LawList>
struct Product<TypeList<EveryMethod...>, LawList> {
  using type = Concatenated<typename WithEveryLaw<EveryMethod, LawList>::type...>;
};

/// Whether a method needs nothing but an element's constants and displacements.
template <class Kernel>
inline constexpr bool stands_alone =
    !Kernel::remembers && !Kernel::needs_coordinates && !Kernel::averages_over_nodes;

/// The pairs that stand alone.
template <class List>
struct Elastic;
template <class... Methods, class... PairedLaws>
struct Elastic<TypeList<MethodWithLaw<Methods, PairedLaws>...>> {
  using type =
      Concatenated<TypeList<>,
                   std::conditional_t<stands_alone<FormulationOf<Methods, PairedLaws>>,
                                      TypeList<ElasticMethodWithLaw<Methods, PairedLaws>>, TypeList<>>...>;
};

/// Whether a method's forces follow from the displacements, not from the path to them or from its speed. The
/// levels of an adaptive method come about on the way; adaptive_test.cpp looks after it.
template <class Method>
inline constexpr bool path_independent = !FormulationOf<Method, NeoHookean>::remembers &&
                                         !DampsOnly<typename Method::Hourglass> && !is_adaptive<Method>;

/// The methods whose answer does not depend on the path.
template <class List>
struct PathIndependent;
template <class... EveryMethod>
struct PathIndependent<TypeList<EveryMethod...>> {
  using type =
      Concatenated<TypeList<>,
                   std::conditional_t<path_independent<EveryMethod>, TypeList<EveryMethod>, TypeList<>>...>;
};

/// The methods of the Updated Lagrangian element.
template <class List>
struct Updated;
template <class... EveryMethod>
struct Updated<TypeList<EveryMethod...>> {
  using type =
      Concatenated<TypeList<>,
                   std::conditional_t<std::is_same_v<typename EveryMethod::Kinematics, UpdatedOnePoint>,
                                      TypeList<EveryMethod>, TypeList<>>...>;
};

/// The methods that support viscoelastic laws.
template <class List>
struct ViscoelasticIn;
template <class... EveryMethod>
struct ViscoelasticIn<TypeList<EveryMethod...>> {
  using type = Concatenated<TypeList<>, std::conditional_t<knows_law<EveryMethod, Viscoelastic<NeoHookean>>,
                                                           TypeList<EveryMethod>, TypeList<>>...>;
};

/// The methods that find their answers step by step.
template <class List>
struct Stepped;
template <class... EveryMethod>
struct Stepped<TypeList<EveryMethod...>> {
  using type =
      Concatenated<TypeList<>,
                   std::conditional_t<is_condensed<EveryMethod>, TypeList<>, TypeList<EveryMethod>>...>;
};

}  // namespace detail

/// The laws whose stress follows from the deformation. Each also comes viscoelastic: what that adds is tested
/// in viscoelastic_test.cpp.
using LawTypes = detail::AsTestTypes<ElasticLaws>::type;
using MethodTypes = detail::AsTestTypes<Methods>::type;
using GeneratorTypes = detail::AsTestTypes<Generators>::type;

/// Pairs of methods and laws that are compiled for tests. Laws and methods meet in few functions, so that
/// every method with the first law, and every law with one method of one point and one of eight, are what can
/// go wrong in a kernel by itself; pairs_test.cpp runs the whole product through the solver.
template <class MethodList>
using PairsOf =
    Concatenated<typename detail::Product<MethodList, typename detail::Split<ElasticLaws>::first>::type,
                 typename detail::Product<TypeList<TlPerturbation, TlMeanDilatation>,
                                          typename detail::Split<ElasticLaws>::others>::type>;

/// The methods that support viscoelastic laws.
using ViscoelasticMethods = detail::ViscoelasticIn<Methods>::type;
using ViscoelasticMethodTypes = detail::AsTestTypes<ViscoelasticMethods>::type;

using MethodWithLawTypes = detail::AsTestTypes<Concatenated<
    PairsOf<Methods>, detail::Product<ViscoelasticMethods, TypeList<Viscoelastic<NeoHookean>>>::type>>::type;

/// What integrates its resistances in time comes to rest where the path leads it, what relaxes takes its
/// time, and what damps loses energy; who expects one answer takes these.
using PathIndependentMethods = detail::PathIndependent<Methods>::type;
using PathIndependentMethodTypes = detail::AsTestTypes<PathIndependentMethods>::type;
using PathIndependentPairTypes = detail::AsTestTypes<PairsOf<PathIndependentMethods>>::type;

using UpdatedLagrangianTypes = detail::AsTestTypes<detail::Updated<Methods>::type>::type;

/// Those of them that take steps, at rest or in motion: a condensed method answers at once, and refuses to
/// move.
using SteppedMethods = detail::Stepped<PathIndependentMethods>::type;
using SteppedMethodTypes = detail::AsTestTypes<SteppedMethods>::type;
using SteppedPairTypes = detail::AsTestTypes<PairsOf<SteppedMethods>>::type;

/// All methods that can move, whatever their answers depend on.
using MovingMethodTypes = detail::AsTestTypes<detail::Stepped<Methods>::type>::type;

using ElasticMethodWithLawTypes = detail::AsTestTypes<detail::Elastic<PairsOf<Methods>>::type>::type;

/// How many zero eigenvalues an element at rest has. Six are the rigid motions. One point
/// without control, or with a control of velocities alone, leaves the twelve hourglass modes.
template <class Method>
constexpr int zero_energy_modes() {
  constexpr auto control = Method::Hourglass::traits;
  return integration_points<Method> == 1 && (!control.active || control.damps_only) ? 18 : 6;
}

/// Test names from the entries' own names. '-' has a meaning in test filters, so it becomes '_'.
struct EntryName {
  template <class Entry>
  static std::string GetName(int /*index*/) {
    std::string label;
    if constexpr (requires { Entry::label(); }) {
      label = Entry::label();
    } else {
      label = std::string(Entry::name);
    }
    std::replace_if(
        label.begin(), label.end(), [](char c) { return c == '-' || c == ' '; }, '_');
    return label;
  }
};

}  // namespace sandglass::verification
