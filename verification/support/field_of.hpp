#pragma once

#include "assembly/layout.hpp"
#include "mesh/mesh.hpp"
#include "sandglass/simulation.hpp"

namespace sandglass::verification {

/// Displacements by nodes, from the view.
template <class Real>
NodalField field_of(const Simulation<Real>& simulation) {
  const NodalView<Real> u = simulation.displacements();
  NodalField field;
  for (const int row : simulation.row_of_node()) {
    const Real* components = u[at(row)];
    field.push_back({components[0], components[1], components[2]});
  }
  return field;
}

}  // namespace sandglass::verification
