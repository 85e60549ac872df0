#pragma once

#include <future>
#include <map>
#include <memory>
#include <mutex>

#include "comparison/answer.hpp"
#include "stability/trial.hpp"

namespace sandglass {

/// Computes a trial. An error becomes part of the answer, not an exception.
Answer compute(const Trial& trial);

/// Answers that several cells need, each computed once, at the first request. May be shared by threads.
class Answers {
 public:
  /// The answer of a trial; waits if another thread is computing it.
  std::shared_ptr<const Answer> of(const Trial& trial);

 private:
  std::mutex mutex_;
  std::map<std::string, std::shared_future<std::shared_ptr<const Answer>>> known_;
};

}  // namespace sandglass
