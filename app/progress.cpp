#include "app/progress.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <csignal>
#include <cstdio>

namespace sandglass {

namespace {

volatile std::sig_atomic_t interrupt_seen = 0;

void note_interrupt(int signal) {
  interrupt_seen = 1;
  std::signal(signal, SIG_DFL);
}

}  // namespace

Progress::Progress(std::string title) : title_(std::move(title)), terminal_(isatty(STDERR_FILENO) == 1) {}

Progress::~Progress() {
  hide();
}

void Progress::hide() {
  if (terminal_ && drawn_) fmt::print(stderr, "\r\x1b[K");
}

void Progress::show(double share, const std::string& remark) {
  using namespace std::chrono_literals;
  const auto now = std::chrono::steady_clock::now();
  if (!drawn_) last_ = now - (terminal_ ? 1s : 0s);
  drawn_ = true;
  if (now - last_ < (terminal_ ? std::chrono::milliseconds(100) : std::chrono::milliseconds(5000))) return;
  last_ = now;
  if (!terminal_) {
    fmt::print(stderr, "{}: {:3.0f} % {}\n", title_, 100.0 * share, remark);
    return;
  }
  constexpr int width = 30;
  const int full = std::clamp(static_cast<int>(share * width), 0, width);
  fmt::print(stderr, "\r\x1b[K{} [{:=<{}}{:<{}}] {:3.0f} % {}", title_, "", full, "", width - full,
             100.0 * share, remark);
  std::fflush(stderr);
}

ProgressOf shown_on(Progress& progress) {
  return [&progress](double share, const std::string& remark) {
    progress.show(share, remark);
    return !interrupted();
  };
}

void watch_for_interrupt() {
  for (const int signal : {SIGINT, SIGTERM}) std::signal(signal, note_interrupt);
}

bool interrupted() {
  return interrupt_seen != 0;
}

}  // namespace sandglass
