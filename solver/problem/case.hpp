#pragma once

#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "element/hourglass_settings.hpp"
#include "element/method_choice.hpp"
#include "forces/forces.hpp"
#include "material/materials.hpp"
#include "mesh/node_set.hpp"
#include "mesh/placed_body.hpp"
#include "problem/fibres.hpp"
#include "problem/settings.hpp"

namespace sandglass {

/// A mesh file, written by `sandglass mesh` or another program, or a labelled image.
struct MeshFile {
  std::filesystem::path path;
  std::optional<Vector> spacing = {};  ///< voxel size, m, for an image without one
};

/// Where a mesh comes from.
using MeshSource = std::variant<AnyGenerator, std::vector<PlacedBody>, MeshFile>;

/// A material, its fibres and its elements.
struct CaseMaterial : Material {
  std::string elements = {};  ///< an element set; empty: all elements that no other material names
  FibreRule fibres = {};
};

/// Repeated splitting of elements into eight.
struct Refinement {
  static constexpr std::string_view name = "refine";
  static constexpr std::string_view summary =
      "splits elements into eight; neighbours differ by at most one split; parts inherit sets and materials; "
      "hanging nodes follow the element on which they hang";

  std::string around;
  std::string elements;
  std::vector<int> numbers;
  int after = 0;
  int depth = 1;
  int layers = 2;

  static constexpr auto parameters() {
    using R = Refinement;
    constexpr Range few{.low = 1, .high = 8, .low_open = false, .high_open = false};
    constexpr Range before{.low = 0, .high = 7, .low_open = false, .high_open = false};
    return std::tuple{
        Parameter{&R::around, "around", "-", Range::any(), "splits elements at the edge of this node set; or",
                  false},
        Parameter{&R::elements, "elements", "-", Range::any(), "splits this element set; or", false},
        Parameter{&R::numbers, "numbers", "-", Range::at_least(0.0),
                  "splits these elements once; numbers count from 0 in the mesh", false},
        Parameter{&R::after, "after", "-", before, "numbers refer to the mesh after so many splits", false},
        Parameter{&R::depth, "depth", "-", few, "how many times elements are split; not with numbers", false},
        Parameter{&R::layers, "layers", "-", few,
                  "layers of elements at the edge that are split, in each split; with around", false}};
  }
  std::optional<BrokenRule> broken_rule() const;
};

/// Nodes that move with elements without being their corners.
struct NodeTie {
  static constexpr std::string_view name = "tie";
  static constexpr std::string_view summary =
      "joins meshes that do not match: nodes inside elements, or on their faces, that are not their corners "
      "move with these elements; not with [[refine]]";

  std::string set;
  std::string elements;

  static constexpr auto parameters() {
    using T = NodeTie;
    return std::tuple{Parameter{&T::set, "set", "-", Range::any(), "a node set"},
                      Parameter{&T::elements, "elements", "-", Range::any(), "an element set"}};
  }
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
  Vector axis{};                 ///< of length one; right-hand rule
  double angle = 0.0;            ///< final angle, rad
  std::optional<Vector> center;  ///< a point on the axis, m; default: the mean of the nodes' positions
  Vector displacement{};         ///< final displacement in addition to the rotation, m
};

/// Initial velocities of nodes; several for one node add up.
struct InitialVelocity {
  static constexpr std::string_view name = "velocity";
  static constexpr std::string_view summary = "initial velocities of a dynamic case; several add up";
  static constexpr std::array<std::string_view, 2> one_of{"value", "spin"};

  std::string set;  ///< empty: the whole body
  Vector value{};
  std::array<int, 3> half_waves{};
  Vector spin{};

  static constexpr auto parameters() {
    using V = InitialVelocity;
    return std::tuple{
        Parameter{&V::set, "set", "-", Range::any(), "a node set instead of the whole body", false},
        Parameter{&V::value, "value", "m/s", Range::any(), "velocity", false},
        Parameter{&V::half_waves, "half_waves", "-", Range::at_least(0.0),
                  "along each axis, for a standing wave between the free ends of the set: value times cos(pi "
                  "half_waves (x - low) / (high - low))",
                  false},
        Parameter{&V::spin, "spin", "rad/s", Range::any(), "about the centre of mass of the set", false}};
  }
};

/// The contents of a case file as plain data, checked key by key.
struct Case : CaseSettings {
  MeshSource mesh;
  std::vector<CaseMaterial> materials = std::vector<CaseMaterial>(1);
  std::vector<NodeSetRule> sets;
  std::vector<NodeSetRule> element_sets;  ///< rules for the centres of elements
  std::vector<Refinement> refinements;
  std::vector<NodeTie> ties;
  std::vector<ImposedDisplacement> displacements;
  std::vector<ImposedRotation> rotations;
  ForceTables<Forces> forces;
  std::vector<InitialVelocity> velocities;
};

/// A hash of everything that affects the answer: mesh recipe, laws, sets, imposed displacements, rotations
/// and forces; for motions also density, damping, duration, ramp time and initial velocities. Method, other
/// settings, numerical parameters of forces and texts are not hashed.
std::string case_hash(const Case& description);

/// What affects how accurately the answer is computed, but not the exact answer: limits of the search for
/// static equilibrium and numerical parameters of forces. "name value ..." in one line.
std::string numerical_settings(const Case& description);

}  // namespace sandglass
