#pragma once

#include <fmt/format.h>

#include <optional>
#include <string>
#include <vector>

#include "app/checkpoint_keeper.hpp"
#include "app/progress.hpp"
#include "app/run_report.hpp"
#include "io/result_file.hpp"
#include "problem/model.hpp"
#include "problem/observer.hpp"

namespace sandglass {

/// Writes frames, history and checkpoints, shows progress, and ends the run on Ctrl-C.
class RunObserver final : public Observer {
 public:
  /// `writer` and `keeper` may be null. The result of a resumed run begins with its earlier part.
  RunObserver(const Model& model, ResultWriter* writer, CheckpointKeeper* keeper)
      : quasi_static_(model.scene().settings.quasi_static),
        duration_(model.scene().settings.dynamics.duration),
        writer_(writer) {
    if (model.choice().ranks->rank() == 0) progress_.emplace(model.scene().settings.name);
    if (keeper != nullptr) {
      for (const auto& earlier : keeper->run().frames) frame(earlier);
      for (const auto& row : keeper->run().history) history(row);
    }
    keeper_ = keeper;
  }

  void frame(const Frame& frame) override {
    if (writer_ != nullptr) writer_->frame(frame);
    if (keeper_ != nullptr) keeper_->frame(frame);
    levels_ = frame.levels;
    volume_ratios_ = frame.jacobians;
  }
  void history(const HistoryRow& row) override {
    if (writer_ != nullptr) writer_->history(row);
    if (keeper_ != nullptr) keeper_->history(row);
    history_.take(row);
  }
  void resumable(const std::function<Checkpoint()>& checkpoint) override {
    if (keeper_ != nullptr) keeper_->resumable(checkpoint);
  }
  void at_load(double factor) override { load_ = factor; }
  bool proceed(long step, double share, double residual) override {
    if (progress_) {
      const std::string where = quasi_static_ ? fmt::format("load {:.3g}, evaluation {}", load_, step)
                                              : fmt::format("{:.3g} s, step {}", share * duration_, step);
      progress_->show(share, fmt::format("{}, residual {:.1e}", where, residual));
    }
    return !interrupted();
  }

  /// Clears the progress line before something else is printed.
  void end() { progress_.reset(); }

  const HistoryReport& found() const { return history_; }
  const std::vector<double>& levels() const { return levels_; }
  const std::vector<double>& volume_ratios() const { return volume_ratios_; }

 private:
  bool quasi_static_;
  double duration_;  // s
  double load_ = 0.0;
  std::optional<Progress> progress_;  // of the first rank
  ResultWriter* writer_;
  CheckpointKeeper* keeper_ = nullptr;
  HistoryReport history_;
  std::vector<double> levels_, volume_ratios_;  // of the last frame
};

}  // namespace sandglass
