#pragma once

#include "problem/scene.hpp"

/// Derivatives of a number by the reference positions of nodes (1/m), as far as they are not those of forces
/// of elements. All fields are of all nodes.
namespace sandglass {

/// A motion that does work: at displacements u (m) and velocities on which dashpots act (m/s; empty: none),
/// the power of forces at velocities v (m/s).
struct Working {
  const NodalField& u;
  const NodalField& u_rate;
  const NodalField& v;
};

/// Adds the derivatives of the power of the forces of a scene, times a factor, at the factors of their load
/// curves. Throws InputError for a force that has none.
void add_slopes_of_forces(double factor, const Scene& scene, std::span<const double> curve_factors,
                          const Working& motion, NodalField& by_points);

/// Adds the derivatives that a number owes to the lumped masses of nodes, from those by masses (1/kg).
void add_slopes_of_masses(const Scene& scene, const std::vector<double>& by_masses, NodalField& by_points);

/// Adds the derivatives that a number owes to the displacements of turned nodes at a load factor, which
/// depend on their positions, from those by imposed displacements (1/m).
void add_slopes_of_rotations(const Scene& scene, double load_factor, const NodalField& by_imposed,
                             NodalField& by_points);

}  // namespace sandglass
