#pragma once

#include <cstddef>

#include "benchmark/roofline.hpp"
#include "mesh/layout.hpp"
#include "model/internal_force.hpp"

namespace sandglass {

/// What a step reads and writes, counted once in each pass through the elements: a row that two strips meet
/// is taken to come from a cache the second time. In numbers of the precision unless said otherwise.
struct Traffic {
  std::size_t constants;       ///< per element
  std::size_t history;         ///< per element, read and written
  std::size_t rows_of_motion;  ///< rows gathered: displacements, and increments or coordinates where needed
  std::size_t passes = 1;      ///< through the elements, each of which reads their constants and places
};

/// The other rows of a step: force written by the elements, which clear it while it is in a cache, and read
/// by the update; inverse mass read; displacement and increment read and written.
inline constexpr std::size_t rows_of_update = 1 + 1 + 1 + 2 + 2;

/// Bytes per element of a mesh of so many elements, spare lanes and rows of the layout included.
double bytes_per_element(const Traffic& traffic, std::size_t bytes_of_number, const Layout& layout,
                         std::size_t elements);

/// Operations, as `sandglass flops` counts them, and bytes of one element and step.
Work work_of(const MethodChoice& choice, const AnyLaw& law, const Layout& layout, std::size_t elements);

}  // namespace sandglass
