#pragma once

/// `SANDGLASS_HOT_LOOP` marks functions that run in steps, searches and their checks. All that they call is
/// inlined, because GCC leaves small matrix functions out of line. Where kernels.cmake defines
/// `SANDGLASS_OPTIMIZE_LOOPS` they are also fully optimised, unlike the rest of their source, which is most
/// of it and would take the compiler longer. A macro, because attributes cannot be named otherwise.
#if defined(SANDGLASS_OPTIMIZE_LOOPS)
#define SANDGLASS_HOT_LOOP [[gnu::flatten, gnu::aligned(64), gnu::optimize("O3")]]
#else
#define SANDGLASS_HOT_LOOP [[gnu::flatten, gnu::aligned(64)]]
#endif
