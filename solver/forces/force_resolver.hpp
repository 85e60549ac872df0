#pragma once

#include <map>
#include <string>

#include "forces/dead_loads.hpp"
#include "forces/load_curve.hpp"

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
  std::vector<double> attached = {};  ///< share of `masses` that is not of elements; empty if there is none
  std::span<const Hexahedron> cells = {};
  std::vector<double> young_moduli = {};  ///< of elements, of the undeformed material, Pa

  /// The nodes of the set that a table names with a key. Throws InputError if there is no such set or it is
  /// empty.
  const std::vector<int>& nodes(std::string_view table, const std::string& set,
                                std::string_view key = "set") const;

  /// The boundary faces within that set. Throws InputError as well if there are none.
  std::vector<Quadrilateral> faces(std::string_view table, const std::string& set,
                                   std::string_view key = "set") const;

  /// The number of a curve, which is added if it is new.
  std::size_t number_of(const LoadCurve& curve);

  /// Adds a dead load (N), `factor` times a force.
  void add_dead(std::size_t curve, int node, const Vector& force, double factor);

  /// All forces, dead loads first.
  BodyForces all() const;
};

}  // namespace sandglass
