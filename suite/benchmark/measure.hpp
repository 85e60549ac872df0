#pragma once

#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "mesh/mesh.hpp"

namespace sandglass {

/// Something that takes steps and is timed.
class Steppable {
 public:
  Steppable() = default;
  Steppable(const Steppable&) = delete;
  Steppable& operator=(const Steppable&) = delete;
  virtual ~Steppable() = default;

  /// Forces (N) in the numbering of the mesh, after a few increments that are the same whatever is timed.
  virtual NodalField forces() = 0;

  /// The number of states in which it is timed, if the cost of a step depends on the state.
  virtual std::size_t states() const { return 1; }

  /// Goes to one of these states, from which a batch of steps starts.
  virtual void restart(std::size_t state) = 0;

  virtual void step() = 0;

  /// Waits for the end of the steps, where another processor takes them.
  virtual void finish() {}

  /// The work of a run every few steps: checks that the body is healthy, and chooses the next step.
  virtual void check() = 0;

  /// Throws ComputationError if the state is not valid.
  virtual void require_healthy() = 0;
};

/// Something to be timed, and the forces that it must compute before it is timed.
struct Entry {
  Steppable* timed;
  const NodalField* reference;  ///< forces, N
  double limit;                 ///< of the relative difference
  int threads = 1;              ///< of its steps; a single one stays on one processor
};

/// The measurements of one entry.
struct Timing {
  std::string status;                     ///< "ok", or the reason why there are no times
  double force_difference;                ///< relative to the reference
  std::vector<double> seconds_per_step;   ///< mean of each batch over its states
  std::vector<double> seconds_of_a_step;  ///< single steps
  std::vector<double> seconds_of_a_check;
};

struct MeasureSettings {
  int repetitions = 100;
  /// A batch has as many steps as fit, at least one in every state. It is shorter than the time slices of a
  /// system, so that most batches run undisturbed even on a busy machine.
  double batch_seconds = 5e-4;
};

/// Called between batches with the share of the work done; if it returns false, the work ends.
using Proceed = std::function<bool(double share)>;

/// Compares the forces of all entries with their references; then times the correct ones in turn, a batch of
/// steps each, in another order in every repetition, so that disturbances affect all alike. Returns one
/// timing per entry. Throws ComputationError if interrupted.
std::vector<Timing> measure(std::span<const Entry> entries, const MeasureSettings& settings,
                            const Proceed& proceed);

}  // namespace sandglass
