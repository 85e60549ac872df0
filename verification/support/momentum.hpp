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

}  // namespace sandglass::verification
