#include "benchmark/statistics.hpp"

#include <algorithm>
#include <stdexcept>

namespace sandglass {

double quantile(std::vector<double> samples, double p) {
  if (samples.empty()) throw std::invalid_argument("quantile: no samples");
  std::sort(samples.begin(), samples.end());
  const double place = std::clamp(p, 0.0, 1.0) * static_cast<double>(samples.size() - 1);
  const auto below = static_cast<std::size_t>(place);
  const std::size_t above = std::min(below + 1, samples.size() - 1);
  return samples[below] + (place - static_cast<double>(below)) * (samples[above] - samples[below]);
}

Spread spread_of(const std::vector<double>& samples) {
  return {quantile(samples, 0.0), quantile(samples, 0.25), quantile(samples, 0.5), quantile(samples, 0.75),
          quantile(samples, 1.0)};
}

}  // namespace sandglass
