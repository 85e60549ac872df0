#pragma once

#include "mesh/mesh.hpp"

namespace sandglass {

/// Displacements (m) at the share s of a step of h seconds, interpolated from displacements and velocities
/// (m/s) at its ends: of third order, so that reported motions do not depend on the positions of the steps.
inline NodalField cubic(double s, double h, const NodalField& u, const NodalField& v,
                        const NodalField& u_after, const NodalField& v_after) {
  const double r = 1.0 - s;
  NodalField between(u.size());
  for (std::size_t n = 0; n < u.size(); ++n)
    for (std::size_t i = 0; i < 3; ++i)
      between[n][i] = r * r * ((1.0 + 2.0 * s) * u[n][i] + s * h * v[n][i]) +
                      s * s * ((1.0 + 2.0 * r) * u_after[n][i] - r * h * v_after[n][i]);
  return between;
}

}  // namespace sandglass
