#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "assembly/internal_force.hpp"
#include "element/hourglass_settings.hpp"
#include "material/materials.hpp"
#include "mesh/generators.hpp"
#include "mesh/node_set.hpp"
#include "problem/fibres.hpp"
#include "problem/load_curve.hpp"
#include "problem/settings.hpp"

namespace sandglass {

/// A mesh read from a file: as `sandglass mesh` writes it, or another program's, or a labelled image.
struct MeshFile {
  std::filesystem::path path;
  std::optional<Vector> spacing = {};  ///< size of an image's voxels, m, where the image has none
};

/// A material, its fibres, and the elements that are made of it.
struct CaseMaterial : Material {
  std::string elements = {};  ///< an element set; empty: all elements that no other material names
  FibreRule fibres = {};
};

/// Elements that are split in eight, their parts again, and so on.
struct Refinement {
  std::string around;        ///< a node set, at whose edge elements are split; or
  std::string elements;      ///< an element set that is split; or
  std::vector<int> numbers;  ///< elements that are split once, numbered in the mesh
  int after = 0;             ///< after so many splits; with `numbers` alone
  int depth = 1;             ///< how often the elements of a set, or at its edge, are split
  int layers = 2;            ///< of elements and parts at the edge that are split
};

/// Nodes that move with elements they are no corners of: where meshes that do not match meet, for instance.
struct NodeTie {
  std::string set;       ///< of nodes; those that are corners of the elements stay as they are
  std::string elements;  ///< an element set
};

/// Displacements imposed on a node set; they follow the loading curve.
struct ImposedDisplacement {
  std::string set;
  Vector value{};                                    ///< final value, m
  std::array<bool, 3> components{true, true, true};  ///< which components are imposed
};

/// A rigid rotation imposed on a node set, u = (R(f angle) - 1)(X - center) + f displacement at the factor f
/// of the loading curve.
struct ImposedRotation {
  std::string set;
  Vector axis{};                 ///< of length one; turns by the right-hand rule
  double angle = 0.0;            ///< final angle, rad
  std::optional<Vector> center;  ///< a point of the axis, m; else the mean of the nodes' positions
  Vector displacement{};         ///< final displacement in addition to the rotation, m
};

/// A dead load on the boundary faces within a node set, or on its nodes.
struct ImposedForce {
  std::string set;
  Vector total{};         ///< sum at the factor one, N
  Vector moment{};        ///< moment about the centroid of the faces, N m
  bool on_nodes = false;  ///< each node has an equal share of the total; else it is spread over the faces
  LoadCurve curve = {};
};

/// A pressure on the boundary faces within a node set: it pushes on them and follows them as they turn and
/// stretch.
struct ImposedPressure {
  std::string set;
  double value = 0.0;  ///< at the factor one, Pa
  LoadCurve curve = {};
};

/// The weight of the body.
struct Gravity {
  Vector value{};  ///< acceleration at the factor one, m/s^2
  LoadCurve curve = {};
};

/// Springs and dashpots between the boundary faces within a node set and the undeformed place (Robin's
/// condition).
struct Support {
  std::string set;
  double stiffness = 0.0;    ///< Pa/m, per area
  double damping = 0.0;      ///< Pa s/m, per area; plays no part in a quasi-static answer
  bool only_normal = false;  ///< they resist motion along the normal of the undeformed face alone
};

/// Velocities in which nodes start; what several say of one node adds up.
struct InitialVelocity {
  std::optional<std::string> set = {};  ///< none: the whole body
  Vector value{};                       ///< m/s
  std::array<int, 3> half_waves{};  ///< of a standing wave between the free ends of the set, on each axis:
                                    ///< value times cos(pi half_waves (x - low) / (high - low))
  Vector spin{};                    ///< rad/s, about the centre of mass of the set
};

/// Everything a case file says, checked key by key; what is inside is plain data.
struct Case {
  std::filesystem::path file;
  std::string name;                   ///< with the names of its variant, "-" between them
  std::string family;                 ///< the name that all variants of a file share
  std::vector<std::string> variants;  ///< its variant on each axis of the file; empty without variants
  std::string requirement;
  bool quasi_static = true;  ///< else dynamic
  std::variant<AnyGenerator, MeshFile> mesh;
  std::vector<CaseMaterial> materials = std::vector<CaseMaterial>(1);
  std::vector<NodeSetRule> sets;
  std::vector<NodeSetRule> element_sets;  ///< for the centres of elements
  std::vector<Refinement> refinements;
  std::vector<NodeTie> ties;
  std::vector<ImposedDisplacement> displacements;
  std::vector<ImposedRotation> rotations;
  std::vector<ImposedForce> forces;
  std::vector<ImposedPressure> pressures;
  std::vector<Gravity> gravity;
  std::vector<Support> supports;
  std::vector<InitialVelocity> velocities;
  RelaxationSettings relaxation;
  DynamicsSettings dynamics;
  std::optional<MethodChoice> method;  ///< what `sandglass run` takes unless told otherwise
};

/// A hash of what decides the answer: mesh recipe, laws, sets, imposed displacements, rotations and loads; in
/// motion also density, damping, duration, ramp time and initial velocities. Method, other settings and words
/// do not enter.
std::string case_hash(const Case& description);

/// Multiplies imposed displacements, angles, forces, moments, pressures, gravity and initial velocities by
/// `factor`.
void scale_load(Case& description, double factor);

}  // namespace sandglass
