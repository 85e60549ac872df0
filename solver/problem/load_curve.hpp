#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <functional>
#include <string>
#include <vector>

namespace sandglass {

/// How a load follows time: a table, linear between its points, constant before the first and after the last,
/// or a formula. Without either it follows the load factor of the case. In a quasi-static answer time is the
/// share of the load, 0 to 1.
struct LoadCurve {
  std::vector<double> times = {};  ///< s, increasing
  std::vector<double> factors = {};
  std::string formula = {};                     ///< as written; empty where there is none
  std::function<double(double)> evaluate = {};  ///< the formula at a time; see io/formula.hpp

  bool operator==(const LoadCurve& other) const {
    return times == other.times && factors == other.factors && formula == other.formula;
  }

  /// The factor of the load, where `load_factor` is that of the case.
  double at(double time, double load_factor) const {
    if (evaluate) return evaluate(time);
    if (times.empty()) return load_factor;
    const auto above = std::upper_bound(times.begin(), times.end(), time);
    if (above == times.begin()) return factors.front();
    if (above == times.end()) return factors.back();
    const auto n = static_cast<std::size_t>(above - times.begin());
    const double share = (time - times[n - 1]) / (times[n] - times[n - 1]);
    return factors[n - 1] + share * (factors[n] - factors[n - 1]);
  }

  /// The largest absolute value; of a formula that of 1001 times in equal distances from 0 to `end`.
  double largest(double end) const {
    if (!evaluate && times.empty()) return 1.0;
    double most = 0.0;
    for (int k = 0; evaluate && k <= 1000; ++k) most = std::max(most, std::abs(evaluate(end * k / 1000)));
    for (const double factor : factors) most = std::max(most, std::abs(factor));
    return most;
  }
};

}  // namespace sandglass
