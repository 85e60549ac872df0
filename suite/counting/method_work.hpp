#pragma once

#include "assembly/method_entry.hpp"
#include "counting/element_work.hpp"
#include "mesh/quality.hpp"

namespace sandglass {

/// The cost of one element of a method in one step. It does not depend on the law's parameters.
struct MethodWork {
  OperationCount operations;  ///< counted by running the kernel
  Traffic traffic;
};

/// The cost with a law on meshes of these shapes.
MethodWork work_of(const MethodEntry& method, const KernelLaw& law, Shapes shapes);

}  // namespace sandglass
