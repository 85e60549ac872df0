#include "benchmark/one_processor.hpp"

#include <cstddef>

namespace sandglass {

OneProcessor::OneProcessor() {
  if (sched_getaffinity(0, sizeof before_, &before_) != 0) return;
  int last = CPU_SETSIZE - 1;
  while (last > 0 && !CPU_ISSET(static_cast<std::size_t>(last), &before_)) --last;
  cpu_set_t one{};
  CPU_SET(static_cast<std::size_t>(last), &one);
  bound_ = sched_setaffinity(0, sizeof one, &one) == 0;
}

OneProcessor::~OneProcessor() {
  if (bound_) sched_setaffinity(0, sizeof before_, &before_);
}

}  // namespace sandglass
