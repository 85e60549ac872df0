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

/// A kernel that computes the forces of `count` elements, with a comment that describes its arrays. Without
/// contraction its results are those of the method's C++ kernel on plain numbers, bit by bit up to the sign
/// of zeros. Real: double or float; the dialect must have it.
template <class Real>
std::string kernel_text(const ForceProgram& force, const Dialect& dialect, const KernelTitle& title);

}  // namespace sandglass
