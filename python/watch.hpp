#pragma once

#include <pybind11/pybind11.h>

#include <chrono>
#include <exception>
#include <optional>

namespace sandglass {

/// Reports the progress of long work to Python and asks it, now and then, whether to continue: not after
/// Ctrl-C, nor after an exception of the callback. The work runs without the GIL.
class Watch {
 public:
  /// `progress` is called with the completed share of the work, or is None.
  explicit Watch(const pybind11::object& progress) : progress_(progress) {}

  bool proceed(double share) {
    constexpr std::chrono::milliseconds often(50);
    const auto now = Clock::now();
    if (error_ || now - last_ < often) return !error_;
    last_ = now;
    const pybind11::gil_scoped_acquire python;
    try {
      if (PyErr_CheckSignals() != 0) throw pybind11::error_already_set();
      if (!progress_.is_none()) progress_(share);
    } catch (const pybind11::error_already_set&) {
      error_ = std::current_exception();
    }
    return !error_;
  }

  /// Returns `work()`, called without the GIL. Throws the exception of Python that ended it, if one did.
  template <class Work>
  auto run(const Work& work) {
    std::exception_ptr failure;
    std::optional<decltype(work())> found;
    {
      const pybind11::gil_scoped_release others;
      try {
        found.emplace(work());
      } catch (...) {
        failure = std::current_exception();
      }
    }
    if (error_) std::rethrow_exception(error_);
    if (failure) std::rethrow_exception(failure);
    return std::move(*found);
  }

 private:
  using Clock = std::chrono::steady_clock;

  const pybind11::object progress_;
  Clock::time_point last_ = Clock::now();
  std::exception_ptr error_;
};

}  // namespace sandglass
