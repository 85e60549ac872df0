#include "solve/steady_step.hpp"

#include <algorithm>
#include <limits>

namespace sandglass {

namespace {

constexpr double first_wait = 500.0;  // steps, some vibrations of most bodies
constexpr double worthwhile = 1.05;   // growth of the step

}  // namespace

SteadyStep::SteadyStep(double damping)
    : longest_wait_(damping > 0.0 ? 1.0 / damping : std::numeric_limits<double>::infinity()) {}

double SteadyStep::next(double longest, double time) {
  longest *= share_;
  const bool first = step_ == 0.0;
  if (first) wait_ = std::min(first_wait * longest, longest_wait_);
  if (first || longest < step_) {
    step_ = first ? first_share * longest : longest;
    least_ = longest;
    since_ = time;
    return step_;
  }
  least_ = std::min(least_, longest);
  if (time - since_ < wait_) return step_;
  if (least_ > worthwhile * step_) {
    step_ = least_;
    wait_ = std::min(2.0 * wait_, longest_wait_);
  }
  least_ = longest;
  since_ = time;
  return step_;
}

void SteadyStep::shorten() {
  constexpr double by = 0.7;
  share_ *= by;
  step_ *= by;
  least_ = step_;
}

}  // namespace sandglass
