#pragma once

#include <cstddef>
#include <functional>
#include <string>

namespace sandglass {

/// Calls work(0) to work(n - 1) on this number of threads (0: one for each processor), each once and in that
/// order of starting, and shows how far it is. Returns false when Ctrl-C ended it before all were called.
/// Rethrows the first exception of a call; no further calls are made then.
bool run_tasks(const std::string& title, std::size_t n, int threads,
               const std::function<void(std::size_t)>& work);

}  // namespace sandglass
