#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <optional>
#include <tuple>
#include <vector>

#include "base/parameter.hpp"
#include "forces/formula.hpp"

namespace sandglass {

/// The factor of a load over time: a table, linear between its points and constant outside, or a formula.
/// Without either it is the load factor of the case. In a quasi-static answer, time is the share of the load,
/// 0 to 1. The declaration of a curve says what its factors multiply.
struct LoadCurve {
  std::vector<double> times = {};  ///< s, increasing
  std::vector<double> factors = {};
  Formula formula = {};
  double share = 1.0;  ///< a factor of all values

  static constexpr auto parameters() {
    using C = LoadCurve;
    return std::tuple{
        Parameter{&C::times, "times", "s", Range::at_least(0.0),
                  "increasing times of the factors; in a quasi-static answer, time is the share of the load, "
                  "0 to 1",
                  false},
        Parameter{&C::factors, "factors", "-", Range::any(),
                  "factors at these times, linear in between and constant outside", false},
        Parameter{
            &C::formula, "formula", "-", Range::any(),
            "instead of a table, a factor as a function of the time t in s, such as \"sin(2*pi*t) * t\"",
            false}};
  }

  std::optional<BrokenRule> broken_rule() const {
    if (!formula.text.empty() && !(times.empty() && factors.empty())) {
      return BrokenRule{"formula",
                        "was given with times or factors; allowed: a formula or a table, not both"};
    }
    if (times.size() != factors.size())
      return BrokenRule{times.empty() ? "factors" : "times",
                        "needs times and factors, one factor for each time"};
    for (std::size_t k = 1; k < times.size(); ++k) {
      if (times[k] > times[k - 1]) continue;
      return BrokenRule{"times", fmt::format("= ..., {}, {}, ... must increase", times[k - 1], times[k])};
    }
    return std::nullopt;
  }

  bool operator==(const LoadCurve& other) const {
    return times == other.times && factors == other.factors && formula.text == other.formula.text &&
           share == other.share;
  }

  /// The factor of the load; `load_factor` is the case's.
  double at(double time, double load_factor) const {
    if (formula.evaluate) return share * formula.evaluate(time);
    if (times.empty()) return share * load_factor;
    const auto above = std::upper_bound(times.begin(), times.end(), time);
    if (above == times.begin()) return share * factors.front();
    if (above == times.end()) return share * factors.back();
    const auto n = static_cast<std::size_t>(above - times.begin());
    const double part = (time - times[n - 1]) / (times[n] - times[n - 1]);
    return share * (factors[n - 1] + part * (factors[n] - factors[n - 1]));
  }

  /// The largest change per share of a quasi-static load; for a formula, between 1001 equidistant shares.
  double steepest() const {
    if (!formula.evaluate && times.empty()) return std::abs(share);
    double most = 0.0;
    for (int k = 0; formula.evaluate && k < 1000; ++k)
      most =
          std::max(most, 1000 * std::abs(formula.evaluate((k + 1) / 1000.0) - formula.evaluate(k / 1000.0)));
    for (std::size_t k = 1; k < times.size(); ++k)
      most = std::max(most, std::abs(factors[k] - factors[k - 1]) / (times[k] - times[k - 1]));
    return std::abs(share) * most;
  }

  /// The largest absolute value; for a formula, at 1001 equidistant times from 0 to `end`.
  double largest(double end) const {
    if (!formula.evaluate && times.empty()) return std::abs(share);
    double most = 0.0;
    for (int k = 0; formula.evaluate && k <= 1000; ++k)
      most = std::max(most, std::abs(formula.evaluate(end * k / 1000)));
    for (const double factor : factors) most = std::max(most, std::abs(factor));
    return std::abs(share) * most;
  }
};

}  // namespace sandglass
