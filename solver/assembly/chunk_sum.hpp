#pragma once

#include <functional>

#include "assembly/layout.hpp"

namespace sandglass {

/// What `sum_over_chunks` does, compiled once.
void sum_called_chunks(const Layout& layout, double* rows, const std::function<void(std::size_t)>& add);
void sum_called_chunks(const Layout& layout, float* rows, const std::function<void(std::size_t)>& add);

/// Clears the rows, four numbers each, and calls add(c) for every chunk c, which adds to them. Each thread
/// takes a run of chunks in the order 0, 2, 1, 4, 3, ...: at every node the even chunk adds before the odd
/// one, for any number of threads and ranks, and data shared by neighbours is still in the cache. The last
/// chunk of a run waits for the thread of the next run.
///
/// Ranks send the rows of their first and last chunk to the ranks below and above. They compute those first,
/// and all others while the messages travel. Afterwards the rows of `Layout::row_blocks` are complete.
template <class Real, class Add>
void sum_over_chunks(const Layout& layout, Real* rows, const Add& add) {
  sum_called_chunks(layout, rows, std::cref(add));  // a copy would allocate
}

}  // namespace sandglass
