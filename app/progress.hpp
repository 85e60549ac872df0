#pragma once

#include <chrono>
#include <string>

#include "choice/choose.hpp"

namespace sandglass {

/// Shows the progress of long work on standard error: a bar on a terminal, elsewhere a plain line every few
/// seconds.
class Progress {
 public:
  explicit Progress(std::string title);
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;
  ~Progress();

  /// Shows the `share` of the work done, in [0, 1], and a short remark.
  void show(double share, const std::string& remark);

  /// Clears the bar before something else is printed.
  void hide();

 private:
  std::string title_;
  bool terminal_;
  bool drawn_ = false;
  std::chrono::steady_clock::time_point last_{};
};

/// A function that shows progress; it returns whether to continue: not after Ctrl-C.
ProgressOf shown_on(Progress& progress);

/// From now on SIGINT (Ctrl-C) and SIGTERM ask the computation to end, so that no file is left half-written;
/// a second signal kills the program.
void watch_for_interrupt();

/// Whether such a signal has arrived.
bool interrupted();

}  // namespace sandglass
