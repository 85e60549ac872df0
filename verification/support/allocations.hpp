#pragma once

namespace sandglass {

/// Calls of operator new since the start of the program, by any thread: a path that must not allocate does
/// not change it. Only programs built with allocations.cpp count; the library does not.
long allocations();

}  // namespace sandglass
