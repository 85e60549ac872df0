#pragma once

#include <chrono>
#include <functional>
#include <optional>

#include "io/checkpoint_file.hpp"
#include "problem/model.hpp"

namespace sandglass {

/// When and where a run is kept, so that the same command goes on after it was killed. What the run told is
/// kept with it: the result of a run that went on is complete.
///
/// A checkpoint that cannot be written costs a warning, not the run: the run needs none to go on, the former
/// one stays in place, and the next attempt comes with the next one due.
class CheckpointKeeper {
 public:
  /// Takes up the run that `file` holds, if it is there. A checkpoint is written where the run can go on from
  /// and `seconds` have passed since the last one, or the run is being interrupted. Throws InputError when
  /// the file is that of another run, damaged, or its folder is not there.
  CheckpointKeeper(const Model& model, std::filesystem::path file, double seconds);

  /// Where to go on; null at a new start.
  const Checkpoint* from() const { return resumed_ ? &run_.point : nullptr; }

  /// All that was told so far.
  const RunSoFar& run() const { return run_; }

  // What an Observer is told:
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
