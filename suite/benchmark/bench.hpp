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

/// What computes the forces: "pack", "scalar", or "device" for another processor.
std::string_view kernel_name(const MethodChoice& choice);

/// The variants to measure.
struct BenchPlan {
  std::vector<std::string> methods;
  std::vector<Precision> precisions;
  std::vector<int> threads;
  std::shared_ptr<const Processor> processor = nullptr;  ///< to measure too
  MeasureSettings settings;
};

/// Times and figures derived from them.
struct Speed {
  Spread ns;            ///< per element and step, over batches
  double check_ns;      ///< of a run's checks between steps, per element and step
  double p50_us;        ///< of single steps
  double p99_us;        ///< of single steps
  double max_us;        ///< of single steps
  long steps;           ///< timed
  double gflops;        ///< counted operations over the median
  double peak_share;    ///< of the peak with this number of threads
  double gbs;           ///< estimated bytes over the median
  double memory_share;  ///< of the triad in memory; above 1 if the mesh fits in a cache
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
  std::optional<double> mean_step;  ///< s, of the scene's own motion; none if there is none or it fails
  Ceiling ceiling;                  ///< of this precision, number of threads and working set
  std::optional<Speed> speed;       ///< none when the result is wrong

  /// Wall time of a simulated second at the mean step of the motion, s.
  std::optional<double> per_simulated_second() const;
};

/// Whether the result is wrong.
bool is_wrong(const BenchRecord& record);

/// If the upper quartile of a variant's times exceeds the lower one by more than this factor, it was
/// disturbed.
inline constexpr double most_spread = 1.3;

/// Whether its times were disturbed and should be measured again on a quiet machine.
bool is_disturbed(const BenchRecord& record);

/// Every variant of the plan, and the scalar kernel in double precision if the program has it.
std::vector<MethodChoice> variants_of(const BenchPlan& plan);

/// The own motions of a scene, one for each method that takes steps.
using OwnMotions = std::map<std::string, OwnMotion>;

/// Computes them. Throws ComputationError if interrupted.
OwnMotions follow_own_motions(const Scene& scene, const std::vector<std::string>& methods,
                              const Proceed& proceed);

/// Measures all variants on a scene in turn, starting from the ends of their motions or, without a motion,
/// from waves. If they do not all fit into memory, they are measured in several groups. Condensed methods are
/// left out if their factorisation would take too long.
std::vector<BenchRecord> bench(const Scene& scene, const OwnMotions& motions, const BenchPlan& plan,
                               MachineSpeed& machine, const Proceed& proceed);

/// Fills in the figures that compare the records' times with each other.
void compare_among_each_other(std::vector<BenchRecord>& records);

}  // namespace sandglass
