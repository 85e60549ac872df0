#pragma once

#include <cstddef>

#include "base/subnormals.hpp"

namespace sandglass {

/// Calls body(0) to body(n - 1), divided among `threads` threads in equal contiguous ranges. The calls must
/// not touch each other's data. Subnormal numbers are flushed to zero during the calls.
template <class Body>
void in_parallel(std::size_t n, int threads, const Body& body) {
  if (threads > 1 && n > 1) {
#pragma omp parallel num_threads(threads)
    {
      const FlushSubnormals flush;
#pragma omp for schedule(static) nowait
      for (std::size_t k = 0; k < n; ++k) body(k);
    }
  } else {
    const FlushSubnormals flush;
    for (std::size_t k = 0; k < n; ++k) body(k);
  }
}

}  // namespace sandglass
