#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "written/dialects.hpp"

namespace sandglass {

/// A kernel that is written by hand, in the statements that C and its descendants share: what it does at one
/// of `count` nodes or elements e.
struct NodeKernel {
  enum class Kind { integer, indices, array, results };
  struct Argument {
    std::string_view name;
    Kind kind;
    std::string_view meaning;
  };

  std::string_view name;
  std::string_view meaning;
  std::vector<Argument> arguments;  ///< after the count
  std::string_view body;
};

/// The list of the kernels that keep the state of a body on a device: `sum_at_nodes` adds forces of elements,
/// `move_nodes` does so, subtracts loads, follows constraints and takes a step of central differences, and
/// `find_ill` finds elements that are inverted or not finite.
const std::vector<NodeKernel>& node_kernels();

/// The kernel of this name.
const NodeKernel& node_kernel(std::string_view name);

/// Its text, with a comment that describes its arguments. In a dialect with shared arrays, the integers of a
/// kernel are those of its input, and where its arrays begin in them.
template <class Real>
std::string node_kernel_text(const NodeKernel& kernel, const Dialect& dialect);

/// The texts of all, for one file.
template <class Real>
std::string node_kernels_text(const Dialect& dialect);

}  // namespace sandglass
