#pragma once

#include "model/assembly_of.hpp"
#include "model/method_dispatch.hpp"

/// The definition of `assemble_part`, for the source files that instantiate it; see CMakeLists.txt.
namespace sandglass {

template <class Number, std::size_t part>
ForceOf<Number> assemble_part(const Mesh& mesh, const AnyLaw& any_law, const MethodChoice& choice,
                              const HourglassSettings& settings) {
  static_assert(part < assembly_parts, "CMakeLists.txt makes more parts than there are");
  ForceOf<Number> force;
  for_each_type(Methods{}, [&]<class Method>() {
    if constexpr (part_of<Method>() == part) {
      if (Method::name != choice.method) return;
      std::visit(
          [&](const auto& chosen) {
            const auto law = kernel_law(chosen);
            using Law = std::remove_const_t<decltype(law)>;
            if constexpr (knows_law<Method, Law>) {
              force = std::make_unique<AssemblyOf<Method, Law, Number>>(mesh, law, settings, choice.threads);
            } else {
              throw InputError(
                  fmt::format("law: '{}' relaxes, which method '{}' takes no notice of; allowed: an elastic "
                              "law, or another method",
                              name_of(any_law), Method::name));
            }
          },
          any_law);
    }
  });
  return force;
}

}  // namespace sandglass
