#include "app/task_pool.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <exception>
#include <mutex>
#include <thread>
#include <vector>

#include "app/progress.hpp"

namespace sandglass {

bool run_tasks(const std::string& title, std::size_t n, int threads,
               const std::function<void(std::size_t)>& work) {
  std::atomic<std::size_t> next = 0, done = 0;
  std::atomic<bool> failed = false;
  std::exception_ptr failure;
  std::mutex failing;
  const auto active = [&] { return !interrupted() && !failed; };
  const auto call_all = [&] {
    for (std::size_t k = next++; k < n && active(); k = next++) {
      try {
        work(k);
        ++done;
      } catch (...) {
        const std::lock_guard lock(failing);
        if (!failed.exchange(true)) failure = std::current_exception();
      }
    }
  };
  const int wanted = threads > 0 ? threads : static_cast<int>(std::thread::hardware_concurrency());
  std::vector<std::jthread> pool;
  for (int t = 0; t < std::max(wanted, 1); ++t) pool.emplace_back(call_all);
  {
    Progress progress(title);
    while (done < n && active()) {
      progress.show(static_cast<double>(done) / static_cast<double>(n),
                    fmt::format("{} of {} runs", done.load(), n));
      std::this_thread::sleep_for(std::chrono::milliseconds(50));
    }
  }
  pool.clear();
  if (failure) std::rethrow_exception(failure);
  return done == n;
}

}  // namespace sandglass
