#pragma once

/// `SANDGLASS_HOT_LOOP` marks functions that run in every step: they are compiled with all that they call
/// inlined, because GCC leaves small matrix functions out of line, which costs a third of the time; and,
/// where kernels.cmake defines `SANDGLASS_OPTIMIZE_LOOPS`, with full optimisation, though the rest of their
/// source has little. That halves the time that the optimiser takes: three quarters of a kernel's code is not
/// in such loops. A macro, because attributes cannot be named otherwise.
#if defined(SANDGLASS_OPTIMIZE_LOOPS)
#define SANDGLASS_HOT_LOOP [[gnu::flatten, gnu::aligned(64), gnu::optimize("O3")]]
#else
#define SANDGLASS_HOT_LOOP [[gnu::flatten, gnu::aligned(64)]]
#endif
