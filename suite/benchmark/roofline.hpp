#pragma once

#include <algorithm>

namespace sandglass {

/// What an element asks of the machine in one step.
struct Work {
  double operations;  ///< floating point
  double bytes;       ///< read or written
};

/// What the machine can give.
struct Ceiling {
  double gflops;  ///< 1e9 operations per second
  double gbs;     ///< 1e9 bytes per second
};

/// No step takes less than this for an element, ns: operations and traffic may overlap, neither may go
/// faster.
constexpr double bound_ns(const Work& work, const Ceiling& ceiling) {
  return std::max(work.operations / ceiling.gflops, work.bytes / ceiling.gbs);
}

/// The bound over the time measured for an element and step, ns: 1 for a perfect program.
constexpr double roofline_fraction(const Work& work, const Ceiling& ceiling, double measured_ns) {
  return bound_ns(work, ceiling) / measured_ns;
}

}  // namespace sandglass
