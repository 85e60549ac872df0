#pragma once

namespace sandglass::verification {

/// Calls of operator new since the start of the test program, by any thread: a path that must not allocate
/// does not change it.
long allocations();

}  // namespace sandglass::verification
