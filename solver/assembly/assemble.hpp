#pragma once

#include "assembly/element_assembly.hpp"
#include "assembly/method_entry.hpp"

/// The definition of `assemble`, for the source files of each method; see CMakeLists.txt.
namespace sandglass {

template <class Method, class Number>
ForceOf<Number> assemble(const Mesh& mesh, const KernelLaw& kernel_law, const HourglassSettings& settings,
                         int threads) {
  using Levels = LevelsOf<Method>;
  const CalledLaw elastic = elastic_law(kernel_law);
  if (const auto* law = std::get_if<NeoHookean>(&kernel_law)) {
    using Loop = ForceLoop<Levels, CalledLaw, NeoHookean, Number>;
    return std::make_unique<Loop>(mesh, elastic, elastic, *law, settings, threads);
  }
  using ViscoelasticLaw = Viscoelastic<CalledLaw>;
  if constexpr (knows_law<Method, ViscoelasticLaw>) {
    if (const auto* law = std::get_if<ViscoelasticLaw>(&kernel_law)) {
      return std::make_unique<ForceLoop<Levels, ViscoelasticLaw, ViscoelasticLaw, Number>>(
          mesh, elastic, *law, *law, settings, threads);
    }
  }
  using Loop = ForceLoop<Levels, CalledLaw, CalledLaw, Number>;
  return std::make_unique<Loop>(mesh, elastic, elastic, elastic, settings, threads);
}

template <class Method>
ForceOf<double> assemble_scalar(const Mesh& mesh, const KernelLaw& law, const HourglassSettings& settings,
                                int threads) {
  return assemble<Method, double>(mesh, law, settings, threads);
}

}  // namespace sandglass
