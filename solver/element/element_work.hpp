#pragma once

#include <cstddef>

#include "math/counted.hpp"

/// What one element costs in one step.
namespace sandglass {

/// Operations, by part.
struct OperationCount {
  Operations gradient;   ///< from nodal displacements to displacement gradients and volume changes
  Operations law;        ///< from displacement gradients to stresses
  Operations force;      ///< from stresses to nodal forces
  Operations hourglass;  ///< what the hourglass control adds to an element without it
  Operations total;
  long bytes = 0;  ///< in double: constants and four places of nodes read, history read and written
};

/// What a step reads and writes, counted once in each pass through the elements: a row that two strips meet
/// is taken to come from a cache the second time. In numbers of the precision unless said otherwise.
struct Traffic {
  std::size_t constants;       ///< per element
  std::size_t history;         ///< per element, read and written
  std::size_t rows_of_motion;  ///< rows gathered: displacements, and increments or coordinates where needed
  std::size_t passes = 1;      ///< through the elements, each of which reads their constants and places
};

/// Counts what an element of a formulation reads and writes.
template <class Kernel>
constexpr Traffic traffic_of() {
  Traffic traffic{sizeof(typename Kernel::template Element<double>) / sizeof(double), 0, 1, Kernel::passes};
  if constexpr (Kernel::remembers) {
    traffic.history = sizeof(typename Kernel::template History<double>) / sizeof(double);
  }
  if constexpr (Kernel::needs_increment) ++traffic.rows_of_motion;
  if constexpr (Kernel::needs_coordinates) ++traffic.rows_of_motion;
  // Displacements a second time, and the volumes that the first pass writes and the second reads.
  if constexpr (Kernel::averages_over_nodes) traffic.rows_of_motion += 3;
  return traffic;
}

}  // namespace sandglass
