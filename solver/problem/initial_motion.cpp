#include "problem/initial_motion.hpp"

#include <cmath>
#include <numbers>

namespace sandglass {

InitialMotion::InitialMotion(const InitialVelocity& velocity, const NodalField& points,
                             const std::vector<double>& masses, const std::vector<int>& nodes)
    : velocity_(velocity) {
  low_.fill(std::numeric_limits<double>::infinity());
  high_.fill(-std::numeric_limits<double>::infinity());
  double mass = 0.0;
  for (const int node : nodes) {
    const auto n = static_cast<std::size_t>(node);
    mass += masses[n];
    for (std::size_t i = 0; i < 3; ++i) {
      low_[i] = std::min(low_[i], points[n][i]);
      high_[i] = std::max(high_[i], points[n][i]);
      centre_[i] += masses[n] * points[n][i];
    }
  }
  for (double& x : centre_) x /= mass;
}

std::optional<std::size_t> InitialMotion::axis_without_extent() const {
  for (std::size_t i = 0; i < 3; ++i) {
    if (velocity_.half_waves[i] != 0 && !(low_[i] < high_[i])) return i;
  }
  return std::nullopt;
}

Vector InitialMotion::at(const Vector& X) const {
  double wave = 1.0;
  for (std::size_t i = 0; i < 3; ++i) {
    const int n = velocity_.half_waves[i];
    if (n != 0) wave *= std::cos(std::numbers::pi * n * (X[i] - low_[i]) / (high_[i] - low_[i]));
  }
  Vector v;
  for (std::size_t i = 0; i < 3; ++i) {
    const std::size_t j = (i + 1) % 3, k = (i + 2) % 3;
    v[i] = wave * velocity_.value[i] + velocity_.spin[j] * (X[k] - centre_[k]) -
           velocity_.spin[k] * (X[j] - centre_[j]);
  }
  return v;
}

}  // namespace sandglass
