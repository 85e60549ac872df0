#pragma once

#include <map>
#include <string>

#include "forces/dead_loads.hpp"
#include "forces/load_curve.hpp"
#include "mesh/ties.hpp"

namespace sandglass {

/// Resolves the forces of a case on a mesh; the function `resolve` of each kind adds to it.
struct ForceResolver {
  std::string file;  ///< of the case, for messages
  const NodalField& points;
  const std::vector<Quadrilateral>& boundary;
  const NodeSets& sets;
  std::vector<double>& masses;  ///< of nodes, kg

  std::vector<LoadCurve> curves = {LoadCurve{}};            ///< the first is the case's
  BodyForces forces = {};                                   ///< except dead loads
  std::map<std::pair<std::size_t, int>, Vector> dead = {};  ///< by curve and node, N
  std::vector<LoadSize> sizes_of_dead = {};
  std::vector<SlopesOfLoad> slopes_of_dead = {};
  std::vector<double> attached = {};  ///< share of `masses` that is not of elements; empty if there is none
  std::span<const Hexahedron> cells = {};
  std::vector<double> young_moduli = {};  ///< of elements, of the undeformed material, Pa
  Ties ties = {};                         ///< of nodes to nodes that are not tied
  std::vector<bool> held = {};            ///< whether all components of a node are imposed; empty: none
  bool in_motion = true;                  ///< else in static equilibrium

  /// The nodes of the set that a table names with a key. Throws InputError if there is no such set or it is
  /// empty.
  const std::vector<int>& nodes(std::string_view table, const std::string& set,
                                std::string_view key = "set") const;

  /// The boundary faces within that set. Throws InputError as well if there are none.
  std::vector<Quadrilateral> faces(std::string_view table, const std::string& set,
                                   std::string_view key = "set") const;

  /// The number of a curve, which is added if it is new.
  std::size_t number_of(const LoadCurve& curve);

  /// Adds three curves for the displacement (m) by which a program moves an obstacle, zero until it does.
  /// Returns the number of the first.
  std::size_t add_moves();

  /// Adds a dead load (N), `factor` times a force. A load that changes with the positions or masses of nodes
  /// also adds to `slopes_of_dead`.
  void add_dead(std::size_t curve, int node, const Vector& force, double factor);

  /// Adds the dead loads m a(X) (N) of all nodes, m their masses (kg), X their positions (m) and a an
  /// acceleration (m/s^2), a function that takes and returns Triple of any number type.
  template <class Acceleration>
  void add_by_mass(std::size_t curve, const Acceleration& a);

  /// All forces, dead loads first.
  BodyForces all() const;
};

template <class Acceleration>
void ForceResolver::add_by_mass(std::size_t curve, const Acceleration& a) {
  LoadSize size{};
  for (std::size_t n = 0; n < masses.size(); ++n) {
    const Vector a_n = a(Triple<double>{points[n]}).entries;
    add_dead(curve, static_cast<int>(n), a_n, masses[n]);
    size.force += masses[n] * length(a_n);
  }
  sizes_of_dead.push_back(size);
  slopes_of_dead.push_back([curve, a](Factors factors, const ShapeSlopes& shape) {
    const double f = factors[curve];
    for (std::size_t n = 0; n < shape.masses.size(); ++n) {
      const Triple<double> v{shape.v[n]};
      auto X = from_double<Dual<double>>(Triple<double>{shape.points[n]});
      for (std::size_t i = 0; i < 3; ++i) {
        X.entries[i].slope = 1.0;
        const Dual<double> power = double_dot(from_double<Dual<double>>(v), a(X));
        X.entries[i].slope = 0.0;
        shape.by_points[n][i] += f * shape.masses[n] * power.slope;
        if (i == 0) shape.by_masses[n] += f * power.value;
      }
    }
  });
}

}  // namespace sandglass
