#pragma once

#include <cstddef>
#include <functional>
#include <string>

namespace sandglass {

/// Calls work(0) to work(n - 1) once each, started in this order, on this number of threads (0: one per
/// processor), and shows the progress. Returns false if Ctrl-C ended it before all were called. After an
/// exception it makes no further calls and rethrows the first one.
bool run_tasks(const std::string& title, std::size_t n, int threads,
               const std::function<void(std::size_t)>& work);

}  // namespace sandglass
