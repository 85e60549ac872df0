#pragma once

#include "support/scenes.hpp"

namespace sandglass::verification {

/// What a contact does to a horizontal surface around the origin.
struct Pressed {
  double force = 0.0;       ///< N
  double square_arm = 0.0;  ///< m^2, the mean of the squared distances at which it acts
  double middle = 0.0;      ///< N, at the node at the origin

  /// From the forces of the elements at displacements u (m), which are those of the contact, on the surface
  /// within a distance (m).
  Pressed(const Model& model, const NodalField& u, const std::vector<int>& surface,
          const std::function<double(const Vector&)>& distance, double within) {
    const NodalField forces = internal_forces(model, u);
    double nearest = INFINITY;
    for (const int node : surface) {
      const double r = distance(model.scene().mesh.points[at(node)]), f = -forces[at(node)][2];
      if (r > within) continue;
      force += f;
      square_arm += f * r * r;
      if (r < nearest) middle = f;
      nearest = std::min(nearest, r);
    }
    square_arm /= force;
  }
};

}  // namespace sandglass::verification
