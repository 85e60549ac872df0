#pragma once

#include "model/element_assembly.hpp"
#include "model/method_dispatch.hpp"

/// The definition of `assemble_part`, for the source files that instantiate it; see CMakeLists.txt.
namespace sandglass {

template <class Number, std::size_t part>
ForceOf<Number> assemble_part(const Mesh& mesh, const AnyLaw& any_law, const MethodChoice& choice) {
  static_assert(part < assembly_parts, "CMakeLists.txt makes more parts than there are");
  ForceOf<Number> force;
  for_each_type(Methods{}, [&]<class Method>() {
    for_each_type(Laws{}, [&]<class Law>() {
      if constexpr (part_of<Method, Law>() == part) {
        const Law* law = std::get_if<Law>(&any_law);
        if (law == nullptr || Method::name != choice.method) return;
        force = std::make_unique<ElementAssembly<FormulationOf<Method, Law>, Law, Number>>(
            mesh, *law, HourglassSettings{choice.kappa}, choice.threads);
      }
    });
  });
  return force;
}

}  // namespace sandglass
