#pragma once

#include "math/recorded.hpp"

namespace sandglass {

/// What bounds the speed of a straight-line program on a processor that adds, multiplies, or does both at
/// once in one instruction.
struct ProgramShape {
  int operations = 0;  ///< after sharing, without inputs and constants
  int fused = 0;       ///< products that go into a single sum or difference, and so need no instruction
  int chain = 0;       ///< the longest sequence of operations of which each needs the one before
  int alive = 0;  ///< the most values that are needed later, in the order of recording, without constants

  int instructions() const { return operations - fused; }

  /// The largest share of the peak, which is two operations in each instruction.
  double peak_share() const { return 0.5 * operations / instructions(); }
};

/// The shape of a program.
ProgramShape shape_of(const Program& program);

}  // namespace sandglass
