#pragma once

#include <cstddef>
#include <map>
#include <span>
#include <utility>
#include <vector>

#include "assembly/internal_force.hpp"
#include "benchmark/roofline.hpp"

namespace sandglass {

/// Bytes of the last cache between a processor and memory according to the system; 32 MiB if unknown.
std::size_t last_level_cache();

/// The number of processors on which this process may run.
int available_processors();

/// 1e9 operations per second of independent multiplications and additions, as many at a time as a register
/// holds, fused where the build fuses them.
double measure_peak_gflops(Precision precision, int threads);

/// 1e9 bytes per second of a = b + s c over three arrays, the thirds of `numbers`, counted as STREAM does:
/// two reads and a write.
double measure_triad_gbs(std::span<double> numbers, int threads);

/// The speed of this machine, the best of all measurements.
class MachineSpeed {
 public:
  /// Repeats all measurements made so far, to use a quieter moment.
  void measure_again();

  double peak_gflops(Precision precision, int threads);

  /// Triad over arrays several times larger than the last cache.
  double memory_gbs(int threads);

  /// Triad over arrays as large as a working set, rounded to a power of two: a working set that fits in a
  /// cache is compared with that cache.
  double stream_gbs(std::size_t working_set, int threads);

  Ceiling ceiling(Precision precision, int threads, std::size_t working_set);

 private:
  double triad_gbs(std::size_t bytes, int threads);

  std::vector<double> numbers_;  // of the triad, as many as needed so far
  std::map<std::pair<Precision, int>, double> peaks_;
  std::map<std::pair<std::size_t, int>, double> streams_;
};

}  // namespace sandglass
