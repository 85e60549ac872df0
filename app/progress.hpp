#pragma once

#include <chrono>
#include <string>

namespace sandglass {

/// Shows how far long work is: a bar that redraws itself on a terminal, a plain line every few seconds
/// elsewhere. Everything goes to standard error.
class Progress {
 public:
  explicit Progress(std::string title);
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;
  ~Progress();

  /// `share` of the work done in [0, 1] and a short remark.
  void show(double share, const std::string& remark);

 private:
  std::string title_;
  bool terminal_;
  bool drawn_ = false;
  std::chrono::steady_clock::time_point last_{};
};

/// From now on Ctrl-C, and a request to terminate, ask the running computation to end, so that no file is
/// left half-written; a second one kills the program.
void watch_for_interrupt();

/// Whether the computation was asked to end.
bool interrupted();

}  // namespace sandglass
