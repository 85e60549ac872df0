#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "written/dialects.hpp"
#include "written/force_program.hpp"

namespace sandglass {

/// The name of a kernel in the code, and lines of the comment above it.
struct KernelTitle {
  std::string name;
  std::vector<std::string> comment;
};

/// Where a kernel finds the values at an element's nodes: in arrays of each element's own, or in arrays of
/// rows of four numbers, one row for each node, by the places of the element's nodes in the array `places`.
enum class NodalValues { of_elements, of_nodes };

/// A kernel that computes the forces of `count` elements, with a comment that describes its arrays. Without
/// contraction its results are those of the method's C++ kernel on plain numbers, bit by bit up to the sign
/// of zeros. Real: double or float; the dialect must have it.
template <class Real>
std::string kernel_text(const ForceProgram& force, const Dialect& dialect, const KernelTitle& title,
                        NodalValues nodal_values = NodalValues::of_elements);

}  // namespace sandglass
