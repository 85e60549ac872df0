#pragma once

#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "mesh/mesh.hpp"

namespace sandglass {

/// Something that takes steps: what is timed.
class Candidate {
 public:
  Candidate() = default;
  Candidate(const Candidate&) = delete;
  Candidate& operator=(const Candidate&) = delete;
  virtual ~Candidate() = default;

  /// Forces (N) in the numbering of the mesh, after a few increments that are the same for all candidates.
  virtual NodalField forces() = 0;

  /// States in which it is timed, where steps do not cost the same in all.
  virtual std::size_t states() const { return 1; }

  /// Goes to one of these states, where a batch of steps begins.
  virtual void restart(std::size_t state) = 0;

  virtual void step() = 0;

  /// What a run does between some steps: looks whether the body is healthy, and chooses the next step.
  virtual void check() = 0;

  /// Throws ComputationError when the state is not one to go on from.
  virtual void require_healthy() = 0;
};

/// A candidate and what it must compute before it may run.
struct Entry {
  Candidate* candidate;
  const NodalField* reference;  ///< forces, N
  double limit;                 ///< of the relative difference
  int threads = 1;              ///< of the candidate; with one it stays on one processor
};

/// What was measured of one entry.
struct Timing {
  std::string status;                     ///< "ok", or why there are no times
  double force_difference;                ///< relative to the reference
  std::vector<double> seconds_per_step;   ///< mean of each batch, and over the states of the candidate
  std::vector<double> seconds_of_a_step;  ///< single steps
  std::vector<double> seconds_of_a_check;
};

struct MeasureSettings {
  int repetitions = 100;
  /// A batch is as many steps as fit, at least one in every state: shorter than the time for which a system
  /// gives a processor to somebody else, so that most batches run undisturbed on a busy machine too.
  double batch_seconds = 5e-4;
};

/// Called between batches with the share of the work done; returning false ends the work.
using Proceed = std::function<bool(double share)>;

/// Compares the forces of all entries with their references; then times those that are right, all in turn, a
/// batch of steps each, in another order in every repetition, so that a disturbance meets all alike. Returns
/// one timing per entry. Throws ComputationError when told to end.
std::vector<Timing> measure(std::span<const Entry> entries, const MeasureSettings& settings,
                            const Proceed& proceed);

}  // namespace sandglass
