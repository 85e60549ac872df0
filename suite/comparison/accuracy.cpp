#include "comparison/accuracy.hpp"

#include <algorithm>
#include <cmath>

namespace sandglass {

Accuracy accuracy(const NodalField& u, const NodalField& reference, const std::vector<int>* profile,
                  double unit) {
  const auto error = [&](std::size_t n) { return distance(u[n], reference[n]); };
  Accuracy figures;
  double squares = 0.0;
  for (std::size_t n = 0; n < u.size(); ++n) {
    figures.max_relative_error = std::max(figures.max_relative_error, error(n) / unit);
    squares += error(n) * error(n);
  }
  figures.rms_relative_error = std::sqrt(squares / static_cast<double>(u.size())) / unit;
  if (profile != nullptr) {
    double largest = 0.0;
    for (const int n : *profile) largest = std::max(largest, error(static_cast<std::size_t>(n)));
    figures.profile_relative_error = largest / unit;
  }
  return figures;
}

}  // namespace sandglass
