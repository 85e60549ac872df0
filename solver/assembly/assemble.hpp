#pragma once

#include <fmt/format.h>

#include "assembly/adaptive_assembly.hpp"
#include "assembly/element_assembly.hpp"
#include "assembly/method_entry.hpp"
#include "base/error.hpp"

/// The definition of `assemble`, for the source files of each method; see CMakeLists.txt.
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

template <class Method, class Number>
ForceOf<Number> assemble(const Mesh& mesh, const AnyLaw& any_law, const HourglassSettings& settings,
                         int threads) {
  return std::visit(
      [&](const auto& chosen) -> ForceOf<Number> {
        const auto law = kernel_law(chosen);
        using Law = std::remove_const_t<decltype(law)>;
        if constexpr (knows_law<Method, Law>) {
          return std::make_unique<AssemblyOf<Method, Law, Number>>(mesh, law, settings, threads);
        } else {
          throw InputError(
              fmt::format("law: '{}' relaxes, which method '{}' takes no notice of; allowed: an elastic law, "
                          "or another method",
                          name_of(any_law), Method::name));
        }
      },
      any_law);
}

}  // namespace sandglass
