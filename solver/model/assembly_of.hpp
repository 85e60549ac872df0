#pragma once

#include "model/adaptive_assembly.hpp"
#include "model/element_assembly.hpp"

namespace sandglass {

namespace detail {

template <class Method, class Law, class Number>
struct AssemblyOf {
  using type = ElementAssembly<FormulationOf<Method, Law>, Law, Number>;
};
template <class Method, class Law, class Number>
requires is_adaptive<Method>
struct AssemblyOf<Method, Law, Number> {
  using type = AdaptiveAssembly<typename Method::Levels, Law, Number>;
};

}  // namespace detail

/// The elements of a method with a law, as many at a time as `Number` holds.
template <class Method, class Law, class Number>
using AssemblyOf = typename detail::AssemblyOf<Method, Law, Number>::type;

}  // namespace sandglass
