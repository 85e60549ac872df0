#pragma once

#include "assembly/method_facts.hpp"

/// The definition of `method_entry`, for the source file of each method; see CMakeLists.txt.
namespace sandglass {

template <class Method>
MethodEntry method_entry() {
  MethodEntry entry = method_facts<Method>();
  entry.assemble_packed_double = &assemble<KernelOwner<Method>, Pack<double>>;
  entry.assemble_packed_float = &assemble<KernelOwner<Method>, Pack<float>>;
  entry.assemble_scalar_double = &assemble_scalar<KernelOwner<Method>>;
  if constexpr (batches<Method>) {
    entry.assemble_batch_double = &assemble_batch<Method, Pack<double>>;
    entry.assemble_batch_float = &assemble_batch<Method, Pack<float>>;
  }
  entry.auto_kappa = [](const CalledLaw& law, KappaModulus modulus) -> std::optional<double> {
    if constexpr (Method::Hourglass::takes_kappa) return Method::Hourglass::auto_kappa(law, modulus);
    return std::nullopt;
  };
  return entry;
}

}  // namespace sandglass
