#pragma once

#include "element/hourglass_none.hpp"
#include "element/method_traits.hpp"
#include "element/operation_count.hpp"
#include "model/method_entry.hpp"

/// The definition of `method_entry`, for the source file of each method; see CMakeLists.txt.
namespace sandglass {

namespace detail {

template <class Method>
std::optional<double> auto_kappa_of(const AnyLaw& any_law, KappaModulus modulus) {
  if constexpr (Method::Hourglass::takes_kappa) {
    return std::visit([&](const auto& law) { return Method::Hourglass::auto_kappa(law, modulus); }, any_law);
  } else {
    return std::nullopt;
  }
}

/// A law to count: every elastic law as one type, so that the kernels are not compiled anew for each.
template <class Law>
auto counted_law(const Law& law) {
  if constexpr (law_remembers<Law>) {
    return kernel_law(law);
  } else {
    return AnyElasticLaw<ElasticLaws>(law);
  }
}

template <class Method>
OperationCount operations_of(const AnyLaw& any_law) {
  return std::visit(
      [](const auto& law) {
        return count_operations<typename Method::Kinematics, typename Method::Hourglass>(counted_law(law));
      },
      any_law);
}

template <class Method>
Traffic traffic_with(const AnyLaw& any_law) {
  return std::visit([]<class Law>(const Law&) { return traffic_of<FormulationOf<Method, Law>>(); }, any_law);
}

}  // namespace detail

template <class Method>
MethodEntry method_entry() {
  using Hourglass = typename Method::Hourglass;
  return {
      .name = Method::name,
      .summary = Method::summary,
      .integration_points = Method::integration_points,
      .controls_hourglass = Method::integration_points > 1 || !std::is_same_v<Hourglass, NoHourglassControl>,
      .damps_only = DampsOnly<Hourglass>,
      .takes_kappa = Hourglass::takes_kappa,
      .kappa_matters_at_rest = kappa_matters_at_rest<Method>,
      .is_linear = is_linear<Method>,
      .is_condensed = is_condensed<Method>,
      .levels = level_names<Method>(),
      .assemble_packed_double = &assemble<Method, Pack<double>>,
      .assemble_packed_float = &assemble<Method, Pack<float>>,
      .assemble_scalar_double = &assemble<Method, double>,
      .auto_kappa = &detail::auto_kappa_of<Method>,
      .operations = &detail::operations_of<Method>,
      .traffic = &detail::traffic_with<Method>};
}

}  // namespace sandglass
