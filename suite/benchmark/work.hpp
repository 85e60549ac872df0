#pragma once

#include <cstddef>

#include "assembly/layout.hpp"
#include "benchmark/roofline.hpp"
#include "counting/method_work.hpp"

namespace sandglass {

/// The other rows of a step: force written by the elements, which clear it while it is in a cache, and read
/// by the update; inverse mass read; displacement and increment read and written.
inline constexpr std::size_t rows_of_update = 1 + 1 + 1 + 2 + 2;

/// Bytes per element of a mesh of this number of elements, spare lanes and rows of the layout included.
double bytes_per_element(const Traffic& traffic, std::size_t bytes_of_number, const Layout& layout,
                         std::size_t elements);

/// Operations, as `sandglass flops` counts them, and bytes of one element and step.
Work work_of(const MethodChoice& choice, const AnyLaw& law, const Layout& layout, const Mesh& mesh);

}  // namespace sandglass
