#pragma once

#include <optional>
#include <string>

#include "io/result_file.hpp"
#include "problem/case.hpp"

namespace sandglass {

/// Which kernel is written.
struct KernelRequest {
  std::string method;
  std::string dialect = "c";
  std::string precision = {};        ///< "double" or "float"; empty: double where the dialect has it
  std::optional<int> material = {};  ///< its number in the case, from 1; none: the only one
  bool step = false;                 ///< with the kernels that take steps where the state is
};

/// The force of a method's elements with an elastic law of a case, as source in a language; with the kernels
/// of nodes (`node_kernels`), the values at nodes are rows of four numbers. The provenance's version and
/// revision are named in its comment. Throws InputError for a method or law without such a kernel, an unknown
/// dialect, and a precision that it lacks.
std::string kernel_source(const KernelRequest& request, const Case& description,
                          const Provenance& provenance);

/// The bytes of the array `constants` of that kernel, in its precision, for the elements of the case's mesh
/// that have its material, in the order of the mesh: number k of element e at k * count + e. Throws
/// InputError as above.
std::string kernel_constants(const KernelRequest& request, const Case& description);

}  // namespace sandglass
