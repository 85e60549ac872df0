#pragma once

#include <algorithm>
#include <cstddef>
#include <vector>

namespace sandglass {

/// How a load follows time: linear between points, constant before the first and after the last. Without
/// points it follows the load factor of the case. In a quasi-static answer time is the share of the load, 0
/// to 1.
struct LoadCurve {
  std::vector<double> times;  ///< s, increasing
  std::vector<double> factors;

  bool operator==(const LoadCurve&) const = default;

  /// The factor of the load, where `load_factor` is that of the case.
  double at(double time, double load_factor) const {
    if (times.empty()) return load_factor;
    const auto above = std::upper_bound(times.begin(), times.end(), time);
    if (above == times.begin()) return factors.front();
    if (above == times.end()) return factors.back();
    const auto n = static_cast<std::size_t>(above - times.begin());
    const double share = (time - times[n - 1]) / (times[n] - times[n - 1]);
    return factors[n - 1] + share * (factors[n] - factors[n - 1]);
  }

  /// The largest absolute value.
  double largest() const {
    double most = times.empty() ? 1.0 : 0.0;
    for (const double factor : factors) most = std::max(most, factor < 0.0 ? -factor : factor);
    return most;
  }
};

}  // namespace sandglass
