#pragma once

#include <algorithm>
#include <map>
#include <string>
#include <vector>

#include "mesh/refinement.hpp"
#include "problem/case.hpp"
#include "problem/imposed_path.hpp"

namespace sandglass {

/// One imposed displacement component.
struct Constraint {
  int node;
  int component;
  ImposedPath path;
};

/// The mesh of a case with its sets and materials; shared by all methods.
struct Scene {
  Case description;
  Mesh mesh;
  Ties ties = {};                            ///< of nodes, to such as are not tied
  std::vector<CoarserMesh> coarser = {};     ///< the meshes before each refinement, the last first
  std::vector<Quadrilateral> boundary = {};  ///< faces on the boundary of the body
  NodeSets sets = {};
  ElementSets element_sets = {};
  Materials materials = {};
  std::vector<Constraint> constraints = {};                     ///< sorted by node, then component
  std::map<std::string, std::vector<std::size_t>> driven = {};  ///< sets that the case drives -> constraints
  std::vector<double> angles = {};     ///< rad, of paths; the first is zero, for those that do not turn
  std::vector<LoadCurve> curves = {};  ///< of forces; the first is that of the case
  BodyForces forces = {};
  NodalField initial_velocities = {};  ///< m/s; empty: at rest. Imposed components do not obey them
  std::string case_hash = {};
  std::string mesh_hash = {};
};

/// Sets by their rules, materials of the elements, constraints from the imposed displacements and rotations,
/// forces, initial velocities. Throws InputError for an inverted element, an empty
/// set, an element that has no material or two, a node to which two different paths are imposed, a load on a
/// set without boundary faces, and a wave along an axis on which its set has no extent.
Scene make_scene(Case description, Mesh mesh, NodeSets sets_of_file = {},
                 ElementSets element_sets_of_file = {});

/// Calls use(k, n) for every constraint k of the n-th of some nodes.
template <class Use>
void for_each_constraint(const std::vector<Constraint>& constraints, const std::vector<int>& nodes,
                         const Use& use) {
  for (std::size_t n = 0; n < nodes.size(); ++n) {
    auto c = std::ranges::lower_bound(constraints, nodes[n], {}, &Constraint::node);
    for (; c != constraints.end() && c->node == nodes[n]; ++c) {
      use(static_cast<std::size_t>(c - constraints.begin()), n);
    }
  }
}

/// The mesh of a case whose mesh comes from a generator.
Mesh generate_mesh(const AnyGenerator& generator);

/// The nodes, or elements, of a set that `key` of a case names. Throws InputError that names the file and the
/// key if there is no such set, or if it is empty.
const std::vector<int>& node_set(const Scene& scene, const std::string& key, const std::string& name);
const std::vector<int>& element_set(const Scene& scene, const std::string& key, const std::string& name);

/// Largest imposed displacement, m: of a set that turns, the largest on its way, where a displacement besides
/// the rotation counts in full; zero when the case is driven by forces alone.
double largest_imposed(const Scene& scene);

/// The final displacement (m) of a constraint, where the load factor is one.
double final_value(const Scene& scene, const Constraint& constraint);

/// Upper bound of the speeds |du/df| (m) of all imposed nodes on their ways; sharp where nothing moves and
/// turns at once.
double fastest_imposed(const Scene& scene);

/// The unit of all relative errors against a reference (m): the largest imposed displacement; where none is
/// imposed, the reference's own largest.
double displacement_unit(const Scene& scene, const NodalField& reference);

}  // namespace sandglass
