#pragma once

#include <fmt/format.h>

#include "base/error.hpp"
#include "base/names.hpp"
#include "element/methods.hpp"
#include "math/lanes.hpp"
#include "model/internal_force.hpp"

/// From a method's name to its kernels. Every pair of method and law is a kernel, for each number type: too
/// many for one source file. They are dealt out, so that they compile side by side.
namespace sandglass {

/// Calls visit.operator()<Method>() for the method of that name, or throws.
template <class Visitor>
void with_method(std::string_view name, Visitor&& visit) {
  if (!with_named_type(Methods{}, name, visit)) {
    throw InputError(
        fmt::format("method: '{}' is not known; {}", name, suggestion(name, names_of(Methods{}))));
  }
}

/// Source files per number type. CMakeLists.txt makes them and knows this number; too few do not link.
inline constexpr std::size_t assembly_parts = 6;

/// The part that has a method, with all laws.
template <class Method>
constexpr std::size_t part_of() {
  return index_in<Method>(Methods{}) % assembly_parts;
}

/// Elements that compute as many at a time as `Number` holds.
template <class Number>
using ForceOf = std::unique_ptr<InternalForce<typename Lanes<Number>::Scalar>>;

/// The elements of a mesh if the chosen method belongs to this part; else none.
template <class Number, std::size_t part>
ForceOf<Number> assemble_part(const Mesh& mesh, const AnyLaw& law, const MethodChoice& choice,
                              const HourglassSettings& settings);

/// The elements of a mesh, from the part that has them.
template <class Number>
ForceOf<Number> assemble(const Mesh& mesh, const AnyLaw& law, const MethodChoice& choice,
                         const HourglassSettings& settings) {
  ForceOf<Number> force;
  const auto look_in = [&]<std::size_t part>() {
    force = assemble_part<Number, part>(mesh, law, choice, settings);
    return force != nullptr;
  };
  [&]<std::size_t... part>(std::index_sequence<part...>) {
    static_cast<void>((look_in.template operator()<part>() || ...));
  }
  (std::make_index_sequence<assembly_parts>{});
  return force;
}

}  // namespace sandglass
