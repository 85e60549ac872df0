#pragma once

#include <algorithm>

#include "assembly/layout.hpp"
#include "base/parallel.hpp"

namespace sandglass {

namespace detail {

/// Clears the rows that occur first in a chunk.
template <class Real>
void clear_rows_of(const Layout::Chunk& chunk, Real* rows) {
  std::fill(rows + place_of_row(chunk.first_row), rows + place_of_row(chunk.last_row), Real(0));
}

}  // namespace detail

/// Clears the rows, four numbers each, and calls add(c) for every chunk c, which adds to them. Each thread
/// takes a run of chunks in the order 0, 2, 1, 4, 3, ...: at every node the even chunk adds before the odd
/// one, for any number of threads, and data shared by neighbours is still in the cache. The last chunk of a
/// run waits for the thread of the next run.
template <class Real, class Add>
void sum_over_chunks(const Layout& layout, int threads, Real* rows, const Add& add) {
  const std::size_t count = layout.chunks.size(), pairs = (count + 1) / 2;
  const std::size_t runs = std::min(pairs, static_cast<std::size_t>(threads));
  const auto first_pair = [=](std::size_t run) { return pairs * run / runs; };
  const auto clear = [&](std::size_t c) { detail::clear_rows_of(layout.chunks[c], rows); };
  in_parallel(runs, threads, [&](std::size_t run) {
    for (std::size_t pair = first_pair(run); pair < first_pair(run + 1); ++pair) {
      if (pair > 0) clear(2 * pair - 1);
      clear(2 * pair);
      add(2 * pair);
      if (pair > first_pair(run)) add(2 * pair - 1);
    }
  });
  if (count % 2 == 0) clear(count - 1);
  in_parallel(runs, threads, [&](std::size_t run) {
    const std::size_t last = 2 * first_pair(run + 1) - 1;
    if (last < count) add(last);
  });
}

}  // namespace sandglass
