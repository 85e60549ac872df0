#pragma once

#include <cstddef>

#include "counting/counted.hpp"

/// The cost of one element in one step.
namespace sandglass {

/// Operations, by part.
struct OperationCount {
  Operations gradient;   ///< from nodal displacements to displacement gradients and volume changes
  Operations law;        ///< from displacement gradients to stresses
  Operations force;      ///< from stresses to nodal forces
  Operations hourglass;  ///< of the hourglass control: the difference from the element without it
  Operations total;
  long bytes = 0;  ///< in double: constants and four places of nodes read, history read and written
};

/// The memory traffic of a step, counted once per pass over the elements: a row shared by two strips is
/// assumed to come from a cache the second time. In numbers of the run's precision unless noted.
struct Traffic {
  std::size_t constants;       ///< per element
  std::size_t history;         ///< per element, read and written
  std::size_t rows_of_motion;  ///< rows gathered: displacements, and increments or coordinates where needed
  std::size_t passes = 1;      ///< over the elements; each reads their constants and places
};

/// The memory traffic of an element of a formulation.
template <class Kernel>
constexpr Traffic traffic_of() {
  Traffic traffic{sizeof(typename Kernel::template Element<double>) / sizeof(double), 0, 1, Kernel::passes};
  if constexpr (Kernel::remembers) {
    traffic.history = sizeof(typename Kernel::template History<double>) / sizeof(double);
  }
  if constexpr (Kernel::needs_increment) ++traffic.rows_of_motion;
  if constexpr (Kernel::needs_coordinates) ++traffic.rows_of_motion;
  // Displacements again, and volumes, which the first pass writes and the second reads.
  if constexpr (Kernel::averages_over_nodes) traffic.rows_of_motion += 3;
  return traffic;
}

}  // namespace sandglass
