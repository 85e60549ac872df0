#include "comparison/accuracy.hpp"

#include <algorithm>
#include <cmath>

namespace sandglass {

Accuracy accuracy(const NodalField& u, const NodalField& reference, const std::vector<int>* profile,
                  double unit) {
  const auto distance = [&](std::size_t n) {
    return std::hypot(u[n][0] - reference[n][0], u[n][1] - reference[n][1], u[n][2] - reference[n][2]);
  };
  Accuracy figures;
  double squares = 0.0;
  for (std::size_t n = 0; n < u.size(); ++n) {
    figures.max_relative_error = std::max(figures.max_relative_error, distance(n) / unit);
    squares += distance(n) * distance(n);
  }
  figures.rms_relative_error = std::sqrt(squares / static_cast<double>(u.size())) / unit;
  if (profile != nullptr) {
    double largest = 0.0;
    for (const int n : *profile) largest = std::max(largest, distance(static_cast<std::size_t>(n)));
    figures.profile_relative_error = largest / unit;
  }
  return figures;
}

}  // namespace sandglass
