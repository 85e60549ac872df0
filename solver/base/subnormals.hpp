#pragma once

#if defined(__SSE__)
#include <immintrin.h>
#endif

namespace sandglass {

/// During its lifetime, subnormal numbers are zero in the thread that created it. Ahead of every wave the
/// displacements fade into such numbers, and processors are a hundred times slower with them.
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

}  // namespace sandglass
