#include "commands/task_pool.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <exception>
#include <mutex>
#include <thread>
#include <vector>

namespace sandglass {

bool run_tasks(std::size_t n, int threads, const std::function<void(std::size_t)>& work,
               const ProgressOf& progress) {
  std::atomic<std::size_t> next = 0, done = 0;
  std::atomic<bool> ended = false;
  std::exception_ptr failure;
  std::mutex failing;
  const auto call = [&](const auto& action) {
    try {
      action();
    } catch (...) {
      const std::lock_guard lock(failing);
      if (!failure) failure = std::current_exception();
      ended = true;
    }
  };
  const auto call_all = [&] {
    for (std::size_t k = next++; k < n && !ended; k = next++) {
      call([&] {
        work(k);
        ++done;
      });
    }
  };
  const int wanted = threads > 0 ? threads : static_cast<int>(std::thread::hardware_concurrency());
  std::vector<std::jthread> pool;
  for (int t = 0; t < std::max(wanted, 1); ++t) pool.emplace_back(call_all);
  while (done < n && !ended) {
    call([&] {
      const double share = static_cast<double>(done) / static_cast<double>(n);
      if (!progress(share, fmt::format("{} of {} runs", done.load(), n))) ended = true;
    });
    std::this_thread::sleep_for(std::chrono::milliseconds(50));
  }
  pool.clear();
  if (failure) std::rethrow_exception(failure);
  return done == n;
}

}  // namespace sandglass
