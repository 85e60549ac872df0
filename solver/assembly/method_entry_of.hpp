#pragma once

#include "assembly/method_facts.hpp"
#include "element/operation_count.hpp"

/// The definition of `method_entry`, for the source file of each method; see CMakeLists.txt.
namespace sandglass {

namespace detail {

template <class Method>
std::optional<double> auto_kappa_of(const CalledLaw& law, KappaModulus modulus) {
  if constexpr (Method::Hourglass::takes_kappa) {
    return Method::Hourglass::auto_kappa(law, modulus);
  } else {
    return std::nullopt;
  }
}

/// Calls use(law) with the law behind calls, elastic or viscoelastic, as `operations` and `traffic` take it.
template <class Use>
auto with_called_law(const KernelLaw& kernel_law, const Use& use) {
  const auto* viscoelastic = std::get_if<Viscoelastic<CalledLaw>>(&kernel_law);
  return viscoelastic != nullptr ? use(*viscoelastic) : use(elastic_law(kernel_law));
}

template <class Method>
OperationCount operations_of(const KernelLaw& kernel_law, Shapes shapes) {
  return with_called_law(kernel_law, [&](const auto& law) {
    using Regular = OnParallelepipeds<Method>;
    return shapes == Shapes::any
               ? count_operations<typename Method::Kinematics, typename Method::Hourglass>(law)
               : count_operations<typename Regular::Kinematics, typename Regular::Hourglass>(law);
  });
}

template <class Method>
Traffic traffic_with(const KernelLaw& kernel_law, Shapes shapes) {
  return with_called_law(kernel_law, [&]<class Law>(const Law&) {
    using Regular = FormulationOf<OnParallelepipeds<Method>, Law>;
    return shapes == Shapes::any ? traffic_of<FormulationOf<Method, Law>>() : traffic_of<Regular>();
  });
}

}  // namespace detail

template <class Method>
MethodEntry method_entry() {
  MethodEntry entry = method_facts<Method>();
  entry.assemble_packed_double = &assemble<KernelOwner<Method>, Pack<double>>;
  entry.assemble_packed_float = &assemble<KernelOwner<Method>, Pack<float>>;
  entry.assemble_scalar_double = &assemble_scalar<KernelOwner<Method>>;
  entry.auto_kappa = &detail::auto_kappa_of<Method>;
  entry.operations = &detail::operations_of<Method>;
  entry.traffic = &detail::traffic_with<Method>;
  return entry;
}

}  // namespace sandglass
