#pragma once

#include <chrono>
#include <functional>
#include <optional>

#include "io/checkpoint_file.hpp"
#include "problem/model.hpp"

namespace sandglass {

/// Writes checkpoints, so that the same command resumes a run that was killed. A checkpoint includes
/// everything reported so far, so the result of a resumed run is complete.
///
/// A checkpoint that cannot be written causes a warning only: the run continues, the previous checkpoint
/// stays in place, and the next one is attempted when it is due.
class CheckpointKeeper {
 public:
  /// Resumes the run in `file`, if there is one. A checkpoint is written at the next point from which the run
  /// can resume, once `seconds` have passed since the last one or the run is interrupted. Throws InputError
  /// if the file belongs to another run or is damaged, or if its folder does not exist.
  CheckpointKeeper(const Model& model, std::filesystem::path file, double seconds);

  /// Where to resume; null for a new run.
  const Checkpoint* from() const { return resumed_ ? &run_.point : nullptr; }

  /// Everything reported so far.
  const RunSoFar& run() const { return run_; }

  // The calls of an Observer:
  void frame(const Frame& frame) { run_.frames.push_back(frame); }
  void history(const HistoryRow& row) { run_.history.push_back(row); }
  void resumable(const std::function<Checkpoint()>& checkpoint);

  /// Removes the file: the run is complete, and its result is in place.
  void finish();

 private:
  std::filesystem::path file_;
  Identity identity_;
  std::chrono::duration<double> interval_;
  std::shared_ptr<const Ranks> ranks_;
  std::chrono::steady_clock::time_point last_ = std::chrono::steady_clock::now();
  RunSoFar run_;
  bool resumed_ = false;
};

}  // namespace sandglass
