#pragma once

#include "assembly/assemble.hpp"
#include "assembly/method_entry.hpp"

/// The definitions of `kernels`, for the source files that kernels.cmake makes for each method.
namespace sandglass {

template <class Method, class Number>
Kernels<Number> kernels() {
  Kernels<Number> own;
  if constexpr (std::is_same_v<KernelOwner<Method>, Method>) own.assemble = &assemble<Method, Number>;
  return own;
}

template <class Method>
Kernels<double> scalar_kernels() {
  Kernels<double> own;
  if constexpr (std::is_same_v<KernelOwner<Method>, Method>) own.assemble = &assemble<Method, double>;
  return own;
}

}  // namespace sandglass
