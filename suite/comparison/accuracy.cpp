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

Accuracy accuracy(const Displacements& u, const Displacements& reference, const std::vector<int>* profile,
                  double unit) {
  Accuracy largest;
  for (std::size_t t = 0; t < u.size(); ++t) {
    const Accuracy now = accuracy(u[t], reference[t], profile, unit);
    largest.max_relative_error = std::max(largest.max_relative_error, now.max_relative_error);
    largest.profile_relative_error = std::max(largest.profile_relative_error, now.profile_relative_error);
    largest.rms_relative_error = std::max(largest.rms_relative_error, now.rms_relative_error);
  }
  return largest;
}

std::size_t worst_time(const Displacements& u, const Displacements& reference) {
  std::size_t worst = 0;
  double largest = 0.0;
  for (std::size_t t = 0; t < u.size(); ++t) {
    const double error = largest_distance(u[t], reference[t]);
    if (error > largest) worst = t;
    largest = std::max(largest, error);
  }
  return worst;
}

}  // namespace sandglass
