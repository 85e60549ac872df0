#pragma once

#include <deque>
#include <vector>

#include "multigrid/mixed_vector.hpp"

namespace sandglass {

/// Anderson's acceleration (1965) of an iteration that corrects an unknown by an approximate inverse applied
/// to its residual: it combines the last steps and the changes of the residual along them such that the
/// residual becomes smallest. For a linear problem this is GMRES.
class Acceleration {
 public:
  /// `blocks` of the vectors must live as long.
  explicit Acceleration(const MixedBlocks& blocks) : blocks_(blocks) {}

  /// Forgets all steps.
  void clear() {
    pairs_.clear();
    has_step_ = false;
  }

  /// Replaces the residual at the current point by the smallest one, and sets `step` to the step that leads
  /// there.
  void combine(MixedVector& residual, MixedVector& step);

  /// Records the step taken since.
  void moved(const MixedVector& step) {
    step_ = step;
    has_step_ = true;
  }

 private:
  /// The number of steps it remembers.
  static constexpr std::size_t most_pairs = 15;

  /// A change this many times larger than the current residual is forgotten: in single precision its rounding
  /// would spoil the result, and a body of a few nodes does not have 15 independent steps.
  static constexpr double most_times_residual = 1e5;

  struct Pair {
    MixedVector step;
    MixedVector change;                ///< of the residual
    std::vector<double> with_earlier;  ///< products with the changes of all earlier pairs and its own
    double with_residual = 0.0;        ///< product of the change with the present residual
  };

  void remember(const MixedVector& residual);
  std::vector<double> best_shares() const;

  const MixedBlocks& blocks_;
  std::deque<Pair> pairs_;
  MixedVector before_;  // residual at the start of the last step
  MixedVector step_;
  bool has_step_ = false;
};

}  // namespace sandglass
