#include "benchmark/machine_speed.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <chrono>
#include <fstream>
#include <string>
#include <thread>
#include <vector>

#include "base/parallel.hpp"
#include "math/pack.hpp"

namespace sandglass {

namespace {

using Clock = std::chrono::steady_clock;

double seconds_since(Clock::time_point start) {
  return std::chrono::duration<double>(Clock::now() - start).count();
}

/// Independent chains: more than latency times throughput of common processors, yet few enough for 16
/// registers together with the two factors.
constexpr std::size_t chains = 12;

/// x := a x + b over and over, in every lane of every chain; the fixed point b / (1 - a) keeps numbers
/// normal.
template <class Real>
Real run_chains(long rounds, Real factor) {
  using Number = Pack<Real>;
  const Number a(factor), b(Real(1) - factor);
  std::array<Number, chains> x;
  for (std::size_t k = 0; k < chains; ++k) x[k] = Number(static_cast<Real>(k));
  for (long round = 0; round < rounds; ++round) {
#pragma GCC unroll 12
    for (std::size_t k = 0; k < chains; ++k) x[k] = x[k] * a + b;
  }
  Number sum(Real(0));
  for (const Number& chain : x) sum = sum + chain;
  Real total = 0;
  for (int lane = 0; lane < Number::width; ++lane) total += sum.lanes[lane];
  return total;
}

template <class Real>
double peak_gflops_of(int threads) {
  constexpr long rounds = 200000;
  volatile Real opaque = Real(0.75);
  const Real factor = opaque;
  std::vector<Real> kept(static_cast<std::size_t>(threads));
  const auto run = [&](long n) {
    in_parallel(kept.size(), threads, [&](std::size_t t) { kept[t] = run_chains<Real>(n, factor); });
  };
  run(rounds / 10);  // wakes threads and vector units
  const auto start = Clock::now();
  run(rounds);
  const double seconds = seconds_since(start);
  opaque = kept[0];  // keeps the compiler from dropping the work
  return 2.0 * static_cast<double>(chains) * native_width<Real> * static_cast<double>(rounds) * threads /
         seconds * 1e-9;
}

constexpr int tries = 5;

}  // namespace

std::size_t last_level_cache() {
  // The C library may report the sum of all caches of a socket, although a processor uses one of them.
  std::size_t kibibytes = 0;
  for (const char* index : {"2", "3"}) {
    std::ifstream size(std::string("/sys/devices/system/cpu/cpu0/cache/index") + index + "/size");
    if (std::size_t found = 0; size >> found) kibibytes = std::max(kibibytes, found);
  }
  return kibibytes > 0 ? kibibytes << 10 : std::size_t{32} << 20;
}

int available_processors() {
  return std::max(1, static_cast<int>(std::thread::hardware_concurrency()));
}

double measure_peak_gflops(Precision precision, int threads) {
  double best = 0.0;
  for (int k = 0; k < tries; ++k) {
    const bool is_double = precision == Precision::double_precision;
    best = std::max(best, is_double ? peak_gflops_of<double>(threads) : peak_gflops_of<float>(threads));
  }
  return best;
}

double measure_triad_gbs(std::span<double> numbers, int threads) {
  const std::size_t n = numbers.size() / 3;
  volatile double opaque = 3.0;
  const double s = opaque;
  const auto runs = static_cast<std::size_t>(threads);
  const auto pass = [&] {
    in_parallel(runs, threads, [&](std::size_t t) {
      double* sum = numbers.data();
      const double *x = sum + n, *y = sum + 2 * n;
      const std::size_t last = n * (t + 1) / runs;
#pragma omp simd
      for (std::size_t k = n * t / runs; k < last; ++k) sum[k] = x[k] + s * y[k];
    });
  };
  pass();
  const double bytes_of_pass = 3.0 * sizeof(double) * static_cast<double>(n);
  const int passes = std::max(1, static_cast<int>(2e7 / bytes_of_pass));  // about a millisecond
  double best = 0.0;
  for (int k = 0; k < tries; ++k) {
    const auto start = Clock::now();
    for (int p = 0; p < passes; ++p) pass();
    best = std::max(best, passes * bytes_of_pass / seconds_since(start) * 1e-9);
  }
  opaque = numbers[n / 2];
  return best;
}

void MachineSpeed::measure_again() {
  for (auto& [key, best] : peaks_) best = std::max(best, measure_peak_gflops(key.first, key.second));
  for (auto& [key, best] : streams_) best = std::max(best, triad_gbs(key.first, key.second));
}

double MachineSpeed::peak_gflops(Precision precision, int threads) {
  const auto [entry, is_new] = peaks_.try_emplace({precision, threads}, 0.0);
  if (is_new) entry->second = measure_peak_gflops(precision, threads);
  return entry->second;
}

double MachineSpeed::memory_gbs(int threads) {
  return stream_gbs(std::bit_ceil(12 * last_level_cache()), threads);
}

double MachineSpeed::stream_gbs(std::size_t working_set, int threads) {
  // Arrays of four times the cache, as STREAM demands; more than 1.5 GiB in all would not change the result.
  constexpr std::size_t enough = std::size_t{3} << 29;
  const std::size_t largest = std::min(12 * last_level_cache(), enough);
  const std::size_t bytes = std::min(std::bit_ceil(working_set), largest);
  const auto [entry, is_new] = streams_.try_emplace({bytes, threads}, 0.0);
  if (is_new) entry->second = triad_gbs(bytes, threads);
  return entry->second;
}

double MachineSpeed::triad_gbs(std::size_t bytes, int threads) {
  const std::size_t n = std::max<std::size_t>(bytes / sizeof(double), 192);
  if (numbers_.size() < n) numbers_.resize(n, 1.0);
  return measure_triad_gbs(std::span(numbers_).first(n), threads);
}

Ceiling MachineSpeed::ceiling(Precision precision, int threads, std::size_t working_set) {
  return {peak_gflops(precision, threads), stream_gbs(working_set, threads)};
}

}  // namespace sandglass
