#include "benchmark/measure.hpp"

#include <algorithm>
#include <chrono>
#include <random>

#include "base/error.hpp"
#include "benchmark/force_check.hpp"
#include "benchmark/one_processor.hpp"

namespace sandglass {

namespace {

using Clock = std::chrono::steady_clock;

double seconds_between(Clock::time_point start, Clock::time_point end) {
  return std::chrono::duration<double>(end - start).count();
}

double time_steps(Steppable& timed, int steps) {
  const auto start = Clock::now();
  for (int s = 0; s < steps; ++s) timed.step();
  timed.finish();
  return seconds_between(start, Clock::now());
}

/// Goes to a state and takes untimed steps, which wake sleeping threads and refill their caches.
void warm_up(Steppable& timed, std::size_t state, int steps) {
  timed.restart(state);
  for (int s = 0; s < steps; ++s) timed.step();
  timed.finish();
}

int steps_per_batch(Steppable& timed, double batch_seconds) {
  constexpr int most = 2000;
  warm_up(timed, 0, 1);
  const double step = std::min(time_steps(timed, 1), time_steps(timed, 1));
  const double all_states = std::max(step, 1e-9) * static_cast<double>(timed.states());
  return std::clamp(static_cast<int>(batch_seconds / all_states), 1, most);
}

/// In every state, times one batch as a whole for the mean, and another one step by step for the spread of
/// single steps. There are two because reading the clock slows the steps of small meshes.
void time_batches(const Entry& entry, int steps, Timing& timing) {
  Steppable& timed = *entry.timed;
  std::optional<OneProcessor> bound;
  if (entry.threads == 1) bound.emplace();
  double sum = 0.0;
  for (std::size_t state = 0; state < timed.states(); ++state) {
    warm_up(timed, state, (steps + 1) / 2);
    sum += time_steps(timed, steps);
    auto before = Clock::now();
    for (int s = 0; s < steps; ++s) {
      timed.step();
      timed.finish();
      const auto now = Clock::now();
      timing.seconds_of_a_step.push_back(seconds_between(before, now));
      before = now;
    }
    timed.check();
    timing.seconds_of_a_check.push_back(seconds_between(before, Clock::now()));
  }
  timing.seconds_per_step.push_back(sum / (steps * static_cast<double>(timed.states())));
}

}  // namespace

std::vector<Timing> measure(std::span<const Entry> entries, const MeasureSettings& settings,
                            const Proceed& proceed) {
  std::vector<Timing> timings(entries.size());
  std::vector<int> steps(entries.size(), 0);
  std::vector<std::size_t> order;
  const auto require_proceed = [&](double share) {
    if (!proceed(share)) throw ComputationError("bench: interrupted; nothing was written");
  };
  for (std::size_t n = 0; n < entries.size(); ++n) {
    Steppable& timed = *entries[n].timed;
    timings[n].force_difference = relative_difference(timed.forces(), *entries[n].reference);
    timings[n].status = force_status(timings[n].force_difference, entries[n].limit);
    require_proceed(0.0);
    if (timings[n].status != "ok") continue;
    steps[n] = steps_per_batch(timed, settings.batch_seconds);
    time_batches(entries[n], steps[n], timings[n]);  // every batch goes through the same states
    timed.require_healthy();
    timings[n].seconds_per_step.clear();
    timings[n].seconds_of_a_step.clear();
    timings[n].seconds_of_a_check.clear();
    order.push_back(n);
  }
  for (int repetition = 0; repetition < settings.repetitions; ++repetition) {
    std::shuffle(order.begin(), order.end(), std::minstd_rand(static_cast<unsigned>(repetition) + 1U));
    for (const std::size_t n : order) {
      time_batches(entries[n], steps[n], timings[n]);
      require_proceed(static_cast<double>(repetition) / settings.repetitions);
    }
  }
  return timings;
}

}  // namespace sandglass
