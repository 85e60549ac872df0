#pragma once

namespace sandglass {

/// Calls of operator new since the start of the program, by any thread: a path that must not allocate does
/// not change it. A program counts them that is built with allocations.cpp; the library is not.
long allocations();

}  // namespace sandglass
