#pragma once

#include <cstddef>

#if defined(__SSE__)
#include <immintrin.h>
#endif

namespace sandglass {

/// During its lifetime, the thread that created it treats subnormal numbers as zero. Ahead of every wave,
/// displacements decay to such numbers, which are a hundred times slower.
class FlushSubnormals {
 public:
  FlushSubnormals() {
#if defined(__SSE__)
    _mm_setcsr(before_ | _MM_FLUSH_ZERO_ON | denormals_are_zero);
#endif
  }
  ~FlushSubnormals() {
#if defined(__SSE__)
    _mm_setcsr(before_);
#endif
  }
  FlushSubnormals(const FlushSubnormals&) = delete;
  FlushSubnormals& operator=(const FlushSubnormals&) = delete;

 private:
#if defined(__SSE__)
  static constexpr unsigned denormals_are_zero = 0x0040;
  unsigned before_ = _mm_getcsr();
#endif
};

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
