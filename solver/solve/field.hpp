#pragma once

#include <cmath>

#include "mesh/mesh.hpp"

namespace sandglass {

/// The sum over nodes of weight times the scalar product of two fields.
inline double weighted_dot(const std::vector<double>& weight, const NodalField& a, const NodalField& b) {
  double sum = 0.0;
  for (std::size_t n = 0; n < a.size(); ++n) {
    sum += weight[n] * (a[n][0] * b[n][0] + a[n][1] * b[n][1] + a[n][2] * b[n][2]);
  }
  return sum;
}

}  // namespace sandglass
