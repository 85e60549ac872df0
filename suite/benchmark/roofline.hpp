#pragma once

#include <algorithm>

namespace sandglass {

/// The work of an element in one step.
struct Work {
  double operations;  ///< floating point
  double bytes;       ///< read or written
};

/// The speed of the machine.
struct Ceiling {
  double gflops;  ///< 1e9 operations per second
  double gbs;     ///< 1e9 bytes per second
};

/// The least time (ns) of a step for an element: operations and traffic may overlap, but neither can be
/// faster.
constexpr double bound_ns(const Work& work, const Ceiling& ceiling) {
  return std::max(work.operations / ceiling.gflops, work.bytes / ceiling.gbs);
}

/// The bound over the measured time (ns) of an element and step: 1 for a perfect program.
constexpr double roofline_fraction(const Work& work, const Ceiling& ceiling, double measured_ns) {
  return bound_ns(work, ceiling) / measured_ns;
}

}  // namespace sandglass
