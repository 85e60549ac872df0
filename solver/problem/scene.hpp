#pragma once

#include <algorithm>
#include <string>
#include <utility>
#include <vector>

#include "forces/body_force.hpp"
#include "forces/load_curve.hpp"
#include "material/materials.hpp"
#include "mesh/mesh_part.hpp"
#include "mesh/node_set.hpp"
#include "mesh/refinement.hpp"
#include "problem/imposed_path.hpp"
#include "problem/settings.hpp"

namespace sandglass {

/// One imposed displacement component.
struct Constraint {
  int node;
  int component;
  ImposedPath path;
  int group = -1;  ///< the number of its imposed displacement; -1 for none
};

/// A driven node set.
struct DrivenSet {
  std::string name;
  std::vector<std::size_t> constraints;  ///< of its nodes, in the components imposed on the set; ascending
};

/// A node set that turns about an axis, whose paths follow from the positions of its nodes.
struct TurnedSet {
  std::vector<int> nodes;
  Vector axis;        ///< of length one
  std::size_t angle;  ///< index into the scene's angles
  bool about_mean;    ///< the axis passes through the mean of the nodes, else through a fixed point
};

/// The problem that solvers take: a case resolved on its mesh. `make_scene` makes it from a case, the
/// functions below from another scene.
struct Scene {
  CaseSettings settings;
  std::string case_hash;  ///< of the case with the same answer; empty if there is none
  std::string mesh_hash;
  Mesh mesh;
  Ties ties;                            ///< of nodes to nodes that are not tied
  std::vector<CoarserMesh> coarser;     ///< the meshes before each refinement, the last first
  std::vector<Quadrilateral> boundary;  ///< faces on the boundary of the body
  NodeSets sets;
  ElementSets element_sets;
  Materials materials;
  std::vector<Constraint> constraints;  ///< sorted by node, then component
  std::vector<DrivenSet> driven;        ///< sets with an imposed displacement, then rotated sets
  std::vector<double> angles;           ///< rad, of paths; the first is zero, for straight paths
  std::vector<TurnedSet> turned;        ///< the rotated sets, for derivatives by positions
  std::vector<LoadCurve> curves;        ///< of forces; the first is the case's
  BodyForces forces;
  std::vector<double> attached_masses;  ///< of nodes, kg, beside those of elements; empty: none
  NodalField initial_velocities;        ///< m/s; empty: at rest. Imposed components ignore them
};

/// The scene on a part of its mesh, fixed at the rim. The mesh must not have ties.
Scene on_part(const Scene& whole, const MeshPart& part);

/// The scene at rest whose full load is the load of another at a time (s) and load factor, but with the given
/// imposed displacements, values (m) for each constraint, followed by three for each obstacle that a program
/// may move.
Scene with_load(Scene scene, const std::vector<double>& imposed, double time, double load_factor);

/// The scene with the forces of contact in motions, also if its case is static.
Scene in_motion(Scene scene);

/// The scene with imposed displacements, angles, forces and initial velocities multiplied by a factor.
Scene scaled(Scene scene, double factor);

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

/// The nodes, or elements, of a set that `key` of a case names. Throws InputError that names the file and the
/// key if there is no such set, or if it is empty.
const std::vector<int>& node_set(const Scene& scene, const std::string& key, const std::string& name);
const std::vector<int>& element_set(const Scene& scene, const std::string& key, const std::string& name);

/// Largest imposed displacement of a node, m. For a rotated node it is the largest along its path, and a
/// displacement besides the rotation counts in full; zero if only forces drive the case.
double largest_imposed(const Scene& scene);

/// The final displacement (m) of a constraint, at load factor one.
double final_value(const Scene& scene, const Constraint& constraint);

/// Upper bound of the speeds |du/df| (m) of all imposed nodes along their paths; sharp if no node is both
/// displaced and rotated.
double fastest_imposed(const Scene& scene);

/// The unit of all relative errors against a reference (m): the largest imposed displacement or, if there is
/// none, the largest displacement of the reference.
double displacement_unit(const Scene& scene, const NodalField& reference);

}  // namespace sandglass
