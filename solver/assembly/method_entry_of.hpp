#pragma once

#include "assembly/method_facts.hpp"
#include "element/operation_count.hpp"

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

/// A law to count: every elastic law behind calls, so that the kernels are not compiled anew for each.
template <class Law>
auto counted_law(const Law& law) {
  if constexpr (law_remembers<Law>) {
    return kernel_law(law);
  } else {
    return CalledLaw(law);
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
  MethodEntry entry = method_facts<Method>();
  entry.assemble_packed_double = &assemble<Method, Pack<double>>;
  entry.assemble_packed_float = &assemble<Method, Pack<float>>;
  entry.assemble_scalar_double = &assemble<Method, double>;
  entry.auto_kappa = &detail::auto_kappa_of<Method>;
  entry.operations = &detail::operations_of<Method>;
  entry.traffic = &detail::traffic_with<Method>;
  return entry;
}

}  // namespace sandglass
