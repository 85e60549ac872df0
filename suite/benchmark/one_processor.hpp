#pragma once

#include <sched.h>

namespace sandglass {

/// Keeps the calling thread on one processor while it lives: the last one that it may use, as interrupts
/// mostly come to the first. It changes nothing where the system refuses.
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
