#pragma once

#include <deque>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "benchmark/machine_speed.hpp"
#include "benchmark/measure.hpp"
#include "benchmark/own_motion.hpp"
#include "benchmark/statistics.hpp"
#include "problem/model.hpp"

namespace sandglass {

std::string_view name_of(KernelWidth kernel);  ///< "pack" or "scalar"

/// What is to be measured.
struct BenchPlan {
  std::vector<std::string> methods;
  std::vector<Precision> precisions;
  std::vector<int> threads;
  MeasureSettings settings;
};

/// Times and what follows from them.
struct Speed {
  Spread ns;            ///< per element and step, of batches
  double check_ns;      ///< per element and step, of the checks of a run between steps
  double p50_us;        ///< of single steps
  double p99_us;        ///< of single steps
  double max_us;        ///< of single steps
  long steps;           ///< timed
  double gflops;        ///< counted operations over the median
  double peak_share;    ///< of the peak with this number of threads
  double gbs;           ///< estimated bytes over the median
  double memory_share;  ///< of the triad in memory; above 1 when a mesh stays in a cache
  double roofline_fraction;
  std::optional<double> to_tl_perturbation;  ///< time over that of tl-perturbation, same kernel and numbers
  std::optional<double> speedup;  ///< time of the scalar double kernel over this one, same method and threads
};

/// One variant of one method on one mesh.
struct BenchRecord {
  std::string case_name;
  std::size_t elements;
  std::size_t nodes;
  MethodChoice choice;
  std::string status;  ///< "ok", "wrong result: ...", or "left out: ..."
  double force_difference;
  double force_limit;
  Work work;                        ///< per element and step
  std::optional<double> mean_step;  ///< s, of the scene's own motion; none where there is none, or it fails
  Ceiling ceiling;                  ///< of this precision, number of threads and working set
  std::optional<Speed> speed;       ///< none when the result is wrong

  /// Wall time of a simulated second at the mean step of the motion, s.
  std::optional<double> per_simulated_second() const;
};

/// Whether what was computed is wrong.
bool is_wrong(const BenchRecord& record);

/// Upper over lower quartile of the times of a variant above which something else took its processor.
inline constexpr double most_spread = 1.3;

/// Whether its times were disturbed, so that it should be measured again on a quiet machine.
bool is_disturbed(const BenchRecord& record);

/// Every variant of the plan, and the scalar kernel in double precision where the program has it.
std::vector<MethodChoice> variants_of(const BenchPlan& plan);

/// The own motions of a scene by method, of those methods that take steps.
using OwnMotions = std::map<std::string, OwnMotion>;

/// Follows them. Throws ComputationError when told to end.
OwnMotions follow_own_motions(const Scene& scene, const std::vector<std::string>& methods,
                              const Proceed& proceed);

/// Measures all variants on a scene in turn, from where their motions end; without a motion from waves. When
/// they do not all fit into memory, those that do are measured together and the others after them. Condensed
/// methods are left out where their factorisation would take too long.
std::vector<BenchRecord> bench(const Scene& scene, const OwnMotions& motions, const BenchPlan& plan,
                               MachineSpeed& machine, const Proceed& proceed);

/// The figures that follow from the records' times among each other.
void compare_among_each_other(std::vector<BenchRecord>& records);

}  // namespace sandglass
