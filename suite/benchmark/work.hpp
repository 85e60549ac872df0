#pragma once

#include <cstddef>

#include "assembly/layout.hpp"
#include "benchmark/roofline.hpp"
#include "counting/method_work.hpp"

namespace sandglass {

/// The other rows of a step: the elements write the force, which they clear while it is in a cache, and the
/// update reads it; inverse mass is read; displacement and increment are read and written.
inline constexpr std::size_t rows_of_update = 1 + 1 + 1 + 2 + 2;

/// Bytes per element of a mesh of this number of elements, including unused lanes and rows of the layout.
double bytes_per_element(const Traffic& traffic, std::size_t bytes_of_number, const Layout& layout,
                         std::size_t elements);

/// Operations, as `sandglass flops` counts them, and bytes of one element and step.
Work work_of(const MethodChoice& choice, const AnyLaw& law, const Layout& layout, const Mesh& mesh);

}  // namespace sandglass
