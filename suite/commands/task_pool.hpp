#pragma once

#include <cstddef>
#include <functional>

#include "choice/choose.hpp"

namespace sandglass {

/// Calls work(0) to work(n - 1) once each, started in this order, on this number of threads (0: one per
/// processor). The calling thread only reports progress, "3 of 20 runs", and asks whether to continue.
/// Returns false if that ended the work before all were called. After an exception, of `work` or of
/// `progress`, it makes no further calls and rethrows the first one.
bool run_tasks(std::size_t n, int threads, const std::function<void(std::size_t)>& work,
               const ProgressOf& progress);

}  // namespace sandglass
