#pragma once

#include "mesh/vectors.hpp"
#include "problem/model.hpp"

namespace sandglass::verification {

/// The sums of m v and m x cross v.
struct Momentum {
  Vector linear{}, angular{};

  Momentum(const Model& model, const NodalField& u, const NodalField& v) {
    for (std::size_t n = 0; n < v.size(); ++n) {
      const Vector x = sum(model.scene().mesh.points[n], 1.0, u[n]);
      linear = sum(linear, model.masses()[n], v[n]);
      angular = sum(angular, model.masses()[n], cross(x, v[n]));
    }
  }
};

/// The sum of m u over m.
inline Vector centre_of(const NodalField& field, const std::vector<double>& masses) {
  Vector sum_of_all{};
  double mass = 0.0;
  for (std::size_t n = 0; n < field.size(); ++n) {
    mass += masses[n];
    for (std::size_t i = 0; i < 3; ++i) sum_of_all[i] += masses[n] * field[n][i];
  }
  for (double& x : sum_of_all) x /= mass;
  return sum_of_all;
}

}  // namespace sandglass::verification
