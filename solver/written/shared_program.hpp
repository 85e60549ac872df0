#pragma once

#include "written/force_program.hpp"

namespace sandglass {

/// Force programs with the same steps as one: constants in which they differ, as those of laws with different
/// moduli do, are read from the array `parameters`.
class SharedProgram {
 public:
  explicit SharedProgram(ForceProgram first);

  /// Adds another program; returns false, and adds nothing, if its arrays or steps are different.
  bool add(const ForceProgram& other);

  /// The program of all.
  ForceProgram program() const;

  /// The numbers in `parameters` of each program, in the order of adding; none if all have the same
  /// constants.
  std::vector<std::vector<Constant>> parameters() const;

 private:
  /// Numbers of the constants in which the programs differ.
  std::vector<std::size_t> differing() const;

  ForceProgram first_;
  std::vector<std::vector<Constant>> constants_;  // of each program, in the order of its steps
};

}  // namespace sandglass
