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

/// A pair whose force depends on one element's displacements only, so that it can be tested alone.
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

/// The pairs that can be tested alone.
template <class List>
struct Elastic;
template <class... Methods, class... PairedLaws>
struct Elastic<TypeList<MethodWithLaw<Methods, PairedLaws>...>> {
  using type =
      Concatenated<TypeList<>,
                   std::conditional_t<stands_alone<FormulationOf<Methods, PairedLaws>>,
                                      TypeList<ElasticMethodWithLaw<Methods, PairedLaws>>, TypeList<>>...>;
};

/// Whether a method's forces depend on displacements only, not on the path or its speed. An adaptive method
/// chooses levels along the path; adaptive_test.cpp tests it.
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

/// The laws whose stress depends on the deformation only. Each also has a viscoelastic form, tested in
/// viscoelastic_test.cpp.
using LawTypes = detail::AsTestTypes<ElasticLaws>::type;
using MethodTypes = detail::AsTestTypes<Methods>::type;
using GeneratorTypes = detail::AsTestTypes<Generators>::type;

/// Pairs of methods and laws that are compiled for tests. Laws and methods share few functions, so that every
/// method with the first law, and every law with one method of one point and one of eight, cover the possible
/// errors of a single kernel; pairs_test.cpp runs the whole product in the solver.
template <class MethodList>
using PairsOf =
    Concatenated<typename detail::Product<MethodList, typename detail::Split<ElasticLaws>::first>::type,
                 typename detail::Product<TypeList<TlPerturbation, TlMeanDilatation>,
                                          typename detail::Split<ElasticLaws>::others>::type>;

/// The methods that support viscoelastic laws.
using ViscoelasticMethods = detail::ViscoelasticIn<Methods>::type;

using MethodWithLawTypes = detail::AsTestTypes<Concatenated<
    PairsOf<Methods>, detail::Product<ViscoelasticMethods, TypeList<Viscoelastic<NeoHookean>>>::type>>::type;

/// Methods with a unique answer: static answers of methods that integrate resistances depend on the path,
/// relaxing ones need time, and damping ones lose energy.
using PathIndependentMethods = detail::PathIndependent<Methods>::type;

/// Those that take steps, static or in motion: a condensed method answers directly and supports no motion.
using SteppedMethods = detail::Stepped<PathIndependentMethods>::type;

/// All methods that support motion, whatever their answers depend on.
using MovingMethods = detail::Stepped<Methods>::type;

using UpdatedLagrangianTypes = detail::AsTestTypes<detail::Updated<Methods>::type>::type;

using ElasticMethodWithLawTypes = detail::AsTestTypes<detail::Elastic<PairsOf<Methods>>::type>::type;

/// The number of zero eigenvalues of an undeformed element. Six are the rigid motions. One point without
/// control, or with a control of velocities only, adds the twelve hourglass modes.
template <class Method>
constexpr int zero_energy_modes() {
  constexpr auto control = Method::Hourglass::traits;
  return integration_points<Method> == 1 && (!control.active || control.damps_only) ? 18 : 6;
}

/// The name of an entry as a part of a test's name. '-' has a meaning in test filters, so it becomes '_'.
inline std::string test_label(std::string name) {
  std::ranges::replace_if(
      name, [](char c) { return c == '-' || c == ' '; }, '_');
  return name;
}

/// Test names from the entries' own names.
struct EntryName {
  template <class Entry>
  static std::string GetName(int /*index*/) {
    if constexpr (requires { Entry::label(); }) {
      return test_label(Entry::label());
    } else {
      return test_label(std::string(Entry::name));
    }
  }
};

}  // namespace sandglass::verification
