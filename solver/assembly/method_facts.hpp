#pragma once

#include <type_traits>

#include "assembly/method_entry.hpp"
#include "element/hourglass_none.hpp"
#include "element/method_traits.hpp"

namespace sandglass {

/// The entry of a method without its kernels.
template <class Method>
MethodEntry method_facts() {
  using Hourglass = typename Method::Hourglass;
  return {
      .name = Method::name,
      .summary = Method::summary,
      .integration_points = integration_points<Method>,
      .controls_hourglass = integration_points<Method> > 1 || !std::is_same_v<Hourglass, NoHourglassControl>,
      .damps_only = DampsOnly<Hourglass>,
      .takes_kappa = Hourglass::takes_kappa,
      .kappa_affects_equilibrium = kappa_affects_equilibrium<Method>,
      .pressure_varies = pressure_varies<Method>,
      .is_linear = is_linear<Method>,
      .is_condensed = is_condensed<Method>,
      .knows_viscoelasticity = knows_law<Method, Viscoelastic<CalledLaw>>,
      .levels = level_names<Method>()};
}

}  // namespace sandglass
