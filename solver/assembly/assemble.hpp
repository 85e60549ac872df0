#pragma once

#include "assembly/element_assembly.hpp"
#include "assembly/method_entry.hpp"
#include "mesh/quality.hpp"

namespace sandglass {

/// The elements of a mesh in the form of the method itself.
template <class Method, class Number>
ForceOf<Number> assemble_form(const Mesh& mesh, const Materials& materials, const HourglassSettings& settings,
                              const Team& team) {
  using Levels = LevelsOf<Method>;
  const KernelLaws laws = kernel_laws(materials);
  if (const auto* known = std::get_if<std::vector<NeoHookean>>(&laws)) {
    using Loop = ForceLoop<Levels, CalledLaw, NeoHookean, Number>;
    return std::make_unique<Loop>(mesh, materials, *known, settings, team);
  }
  using ViscoelasticLaw = Viscoelastic<CalledLaw>;
  if constexpr (knows_law<Method, ViscoelasticLaw>) {
    if (const auto* remembering = std::get_if<std::vector<ViscoelasticLaw>>(&laws)) {
      using Loop = ForceLoop<Levels, ViscoelasticLaw, ViscoelasticLaw, Number>;
      return std::make_unique<Loop>(mesh, materials, *remembering, settings, team);
    }
  }
  using Loop = ForceLoop<Levels, CalledLaw, CalledLaw, Number>;
  return std::make_unique<Loop>(mesh, materials, std::get<std::vector<CalledLaw>>(laws), settings, team);
}

/// The elements of a mesh, for `MethodEntry`.
template <class Method, class Number>
ForceOf<Number> assemble(const Mesh& mesh, const Materials& materials, const HourglassSettings& settings,
                         const Team& team) {
  if constexpr (!std::is_same_v<OnParallelepipeds<Method>, Method>) {
    if (shapes_in(mesh) == Shapes::parallelepipeds) {
      return assemble_form<OnParallelepipeds<Method>, Number>(mesh, materials, settings, team);
    }
  }
  return assemble_form<Method, Number>(mesh, materials, settings, team);
}

}  // namespace sandglass
