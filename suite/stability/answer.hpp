#pragma once

#include <future>
#include <map>
#include <memory>
#include <mutex>

#include "comparison/finding.hpp"
#include "solve/observer.hpp"
#include "stability/trial.hpp"

namespace sandglass {

/// What a trial gave.
struct Answer {
  NodalField u;                         ///< m; empty where the computation broke down
  double energy = 0.0;                  ///< strain and hourglass energy at u, J
  std::optional<Finding> failure = {};  ///< how it broke down, or that it is not at rest
  bool refused = false;                 ///< the method does not take this case
  std::string status = "ok";            ///< or why not, in words
  long steps = 0;
};

/// The answer of a scene at rest, told to an observer while it is found. What goes wrong becomes part of the
/// answer, not an exception.
Answer answer_at_rest(const Scene& scene, const MethodChoice& choice, Observer& observer);

/// Computes a trial. What goes wrong becomes part of the answer, not an exception.
Answer compute(const Trial& trial);

/// Answers that several cells need, each computed once, by whoever asks first. May be shared by threads.
class Answers {
 public:
  /// The answer of a trial; waits where somebody else is at it.
  std::shared_ptr<const Answer> of(const Trial& trial);

 private:
  std::mutex mutex_;
  std::map<std::string, std::shared_future<std::shared_ptr<const Answer>>> known_;
};

}  // namespace sandglass
