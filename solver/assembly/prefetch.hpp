#pragma once

#include <cstddef>

/// Constants of elements that do not stay in a core's caches from step to step are asked for ahead of time.
namespace sandglass {

/// What a core may keep of the elements in its own caches.
inline constexpr std::size_t cached_bytes = std::size_t{2} << 20U;

/// Levels between the one that is computed and the one whose numbers are sent for: far enough for memory to
/// answer, near enough for the first cache.
inline constexpr std::size_t ranks_ahead = 3;

/// Asks for so many bytes.
inline void prefetch(const void* start, std::size_t size) {
  constexpr std::size_t cache_line = 64;
  for (std::size_t n = 0; n < size; n += cache_line) __builtin_prefetch(static_cast<const char*>(start) + n);
}

}  // namespace sandglass
