#include "assembly/chunk_sum.hpp"

#include <algorithm>
#include <array>

#include "base/parallel.hpp"

namespace sandglass {

namespace {

/// Clears the rows that occur first in a chunk.
template <class Real>
void clear_rows_of(const Layout::Chunk& chunk, Real* rows) {
  std::fill(rows + place_of_row(chunk.first_row), rows + place_of_row(chunk.last_row), Real(0));
}

/// A few chunks, each once.
template <std::size_t most>
struct Chosen {
  std::array<std::size_t, most> chunks{};
  std::size_t count = 0;

  bool has(std::size_t c) const {
    return std::find(chunks.begin(), chunks.begin() + count, c) != chunks.begin() + count;
  }
  void choose(std::size_t c) {
    if (!has(c)) chunks[count++] = c;
  }
};

using AddChunk = std::function<void(std::size_t)>;

template <class Real>
void sum_of(const Layout& layout, Real* rows, const AddChunk& add) {
  const std::size_t first = layout.own_chunks.first, last = layout.own_chunks.last;
  const Ranks& ranks = *layout.team.ranks;
  const int threads = layout.team.threads;
  const bool below = ranks.rank() > 0, above = ranks.rank() + 1 < ranks.count();
  const auto clear = [&](std::size_t c) { clear_rows_of(layout.chunks[c], rows); };
  const auto add_even = [&](std::size_t c) {
    if (c > 0) clear(c - 1);  // this chunk touches them before their own one
    clear(c);
    add(c);
  };
  if (last % 2 == 0 && !above) clear(last - 1);

  Chosen<4> rim_even;
  Chosen<2> rim_odd;
  if (below) {
    rim_even.choose(first);
    if (first + 2 < layout.local_chunks.last) rim_even.choose(first + 2);
    if (first + 1 < last) rim_odd.choose(first + 1);
  }
  if (above) {
    rim_even.choose(last - 2);
    rim_even.choose(last);
    rim_odd.choose(last - 1);
  }
  in_parallel(rim_even.count, threads, [&](std::size_t k) { add_even(rim_even.chunks[k]); });
  in_parallel(rim_odd.count, threads, [&](std::size_t k) { add(rim_odd.chunks[k]); });
  const auto bytes_of = [&](bool exists, std::size_t c) {
    if (!exists) return std::span<std::byte>();
    const auto& chunk = layout.chunks[c];
    return std::as_writable_bytes(
        std::span(rows + place_of_row(chunk.first_row), 4 * (chunk.last_row - chunk.first_row)));
  };
  ranks.start({.to_below = bytes_of(below, first),
               .to_above = bytes_of(above, last - 1),
               .from_below = bytes_of(below, first - 1),
               .from_above = bytes_of(above, last)});

  const std::size_t first_pair = first / 2 + (below ? 2 : 0), last_pair = (last + 1) / 2 - (above ? 1 : 0);
  if (first_pair <= last_pair) {
    const std::size_t pairs = last_pair - first_pair,
                      runs = std::min(pairs, static_cast<std::size_t>(threads));
    const auto begin = [=](std::size_t run) { return first_pair + (run > 0 ? pairs * run / runs : 0); };
    in_parallel(runs, threads, [&](std::size_t run) {
      for (std::size_t pair = begin(run); pair < begin(run + 1); ++pair) {
        add_even(2 * pair);
        if (pair > begin(run)) add(2 * pair - 1);
      }
    });
    in_parallel(runs + 1, threads, [&](std::size_t run) {
      const std::size_t next = 2 * begin(run);
      if (next > first && next <= last && !rim_odd.has(next - 1)) add(next - 1);
    });
  }
  ranks.finish();
}

}  // namespace

void sum_called_chunks(const Layout& layout, double* rows, const AddChunk& add) {
  sum_of(layout, rows, add);
}

void sum_called_chunks(const Layout& layout, float* rows, const AddChunk& add) {
  sum_of(layout, rows, add);
}

}  // namespace sandglass
