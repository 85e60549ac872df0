#pragma once

#include <cstddef>

/// Prefetching of element constants that do not remain in a core's caches from step to step.
namespace sandglass {

/// The bytes of element constants that a core may keep in its own caches.
inline constexpr std::size_t cached_bytes = std::size_t{2} << 20U;

/// The distance, in packs, between computing and prefetching: long enough for memory to respond, short enough
/// for the first-level cache.
inline constexpr std::size_t packs_ahead = 3;

/// Prefetches `size` bytes from `start` on.
inline void prefetch(const void* start, std::size_t size) {
  constexpr std::size_t cache_line = 64;
  for (std::size_t n = 0; n < size; n += cache_line) __builtin_prefetch(static_cast<const char*>(start) + n);
}

}  // namespace sandglass
