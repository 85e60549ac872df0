#pragma once

#include <optional>
#include <set>
#include <string>
#include <variant>
#include <vector>

#include "element/hourglass_settings.hpp"
#include "element/method_choice.hpp"
#include "forces/forces.hpp"
#include "material/materials.hpp"
#include "mesh/generators.hpp"
#include "mesh/node_set.hpp"
#include "problem/fibres.hpp"
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

/// Velocities in which nodes start; what several say of one node adds up.
struct InitialVelocity {
  std::optional<std::string> set = {};  ///< none: the whole body
  Vector value{};                       ///< m/s
  std::array<int, 3> half_waves{};  ///< of a standing wave between the free ends of the set, on each axis:
                                    ///< value times cos(pi half_waves (x - low) / (high - low))
  Vector spin{};                    ///< rad/s, about the centre of mass of the set
};

/// Everything a case file says, checked key by key; what is inside is plain data.
struct Case : CaseSettings {
  std::variant<AnyGenerator, MeshFile> mesh;
  std::vector<CaseMaterial> materials = std::vector<CaseMaterial>(1);
  std::vector<NodeSetRule> sets;
  std::vector<NodeSetRule> element_sets;  ///< for the centres of elements
  std::vector<Refinement> refinements;
  std::vector<NodeTie> ties;
  std::vector<ImposedDisplacement> displacements;
  std::vector<ImposedRotation> rotations;
  ForceTables<Forces> forces;
  std::vector<InitialVelocity> velocities;
};

/// A hash of what decides the answer: mesh recipe, laws, sets, imposed displacements, rotations and forces;
/// in motion also density, damping, duration, ramp time and initial velocities. Method, other settings and
/// words do not enter.
std::string case_hash(const Case& description);

/// The names of the node sets on which its tables act, or which they refine around or tie.
std::set<std::string> used_node_sets(const Case& description);

}  // namespace sandglass
