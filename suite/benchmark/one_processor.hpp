#pragma once

#include <sched.h>

namespace sandglass {

/// Keeps the calling thread on one processor during its lifetime: the last available one, as most interrupts
/// go to the first. Does nothing if the system refuses.
class OneProcessor {
 public:
  OneProcessor();
  OneProcessor(const OneProcessor&) = delete;
  OneProcessor& operator=(const OneProcessor&) = delete;
  ~OneProcessor();

 private:
  cpu_set_t before_{};
  bool bound_ = false;
};

}  // namespace sandglass
