#pragma once

#include <algorithm>
#include <vector>

#include "assembly/layout.hpp"

namespace sandglass {

/// Sets the values of elements that other ranks own, in the numbering of a mesh with `count` elements: as
/// many for each.
template <class T>
void gather_elements(const Layout& layout, std::vector<T>& values, std::size_t count) {
  std::vector<double> all(values.size());
  const std::size_t of_each = values.size() / count;
  const auto rank = static_cast<std::size_t>(layout.team.ranks->rank());
  for (std::size_t c = layout.rank_cells[rank]; c < layout.rank_cells[rank + 1]; ++c) {
    if (layout.elements[c] < 0) continue;
    const std::size_t first = of_each * static_cast<std::size_t>(layout.elements[c]);
    for (std::size_t k = first; k < first + of_each; ++k) all[k] = static_cast<double>(values[k]);
  }
  layout.team.ranks->sum(all);
  std::transform(all.begin(), all.end(), values.begin(), [](double value) { return static_cast<T>(value); });
}

/// The same for one value of each element.
template <class T>
void gather_elements(const Layout& layout, std::vector<T>& values) {
  gather_elements(layout, values, values.size());
}

}  // namespace sandglass
