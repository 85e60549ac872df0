#pragma once

#include <map>
#include <vector>

#include "math/spring.hpp"
#include "mesh/vectors.hpp"

namespace sandglass {

/// A row that slips on a contact: the normal, and the coefficient of friction times the direction of slip.
struct Drag {
  std::size_t row;
  Row<float> normal, along;
};

/// The rows where springs of contact drag, with the means over these springs. `free` is 1, or 0 on
/// constrained components.
template <class Real>
std::vector<Drag> drags_of(const std::vector<Spring>& springs, const Rows<Real>& free) {
  struct Sums {
    double weight = 0.0;
    Vector normal{}, along{};
  };
  std::map<int, Sums> by_row;
  for (const Spring& spring : springs) {
    if (spring.drag.x == Row<float>{}.x) continue;
    for (std::size_t n = 0; n < spring.size; ++n) {
      Sums& sums = by_row[spring.nodes[n]];
      const double weight = spring.weights[n];  // negative on the other surface, where both turn round
      sums.weight += std::abs(weight);
      for (std::size_t i = 0; i < 3; ++i) {
        sums.normal[i] += weight * double{spring.root[i]};
        sums.along[i] += weight * double{spring.drag[i]};
      }
    }
  }
  std::vector<Drag> drags;
  for (const auto& [row, sums] : by_row) {
    const double size = length(sums.normal);
    if (!(size > 0.0)) continue;
    Drag drag{at(row), {}, {}};
    for (std::size_t i = 0; i < 3; ++i) {
      drag.normal[i] = static_cast<float>(sums.normal[i] / size);
      drag.along[i] =
          static_cast<float>(static_cast<double>(free[drag.row][i]) * sums.along[i] / sums.weight);
    }
    drags.push_back(drag);
  }
  return drags;
}

/// Replaces in residuals r (N) of rows that slip the force of the contact along the surface, which is as
/// stiff as the contact, by that which friction makes of the other normal forces: r + along (normal . r).
/// Both vanish together.
inline void replace_drags(const std::vector<Drag>& drags, Rows<float>& residuals) {
  for (const Drag& drag : drags) {
    Row<float>& r = residuals[drag.row];
    const float normal = drag.normal[0] * r[0] + drag.normal[1] * r[1] + drag.normal[2] * r[2];
    for (std::size_t i = 0; i < 3; ++i) r[i] += normal * drag.along[i];
  }
}

}  // namespace sandglass
