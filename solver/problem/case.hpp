#pragma once

#include <optional>
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
  static constexpr std::string_view name = "refine";
  static constexpr std::string_view summary =
      "splits elements in eight, and others so that neighbours differ by one split at most; sets and "
      "materials pass on to the parts, and nodes that hang follow the element they hang on";

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
        Parameter{&R::around, "around", "-", Range::any(), "a node set, at whose edge elements are split; or",
                  false},
        Parameter{&R::elements, "elements", "-", Range::any(), "an element set that is split; or", false},
        Parameter{&R::numbers, "numbers", "-", Range::at_least(0.0),
                  "elements that are split once, by their numbers from 0 in the mesh", false},
        Parameter{&R::after, "after", "-", before, "this many splits; with numbers", false},
        Parameter{&R::depth, "depth", "-", few, "how often the elements of a set, or at its edge, are split",
                  false},
        Parameter{&R::layers, "layers", "-", few,
                  "of elements, and again of their parts, at the edge that are split; with around", false}};
  }
  std::optional<BrokenRule> broken_rule() const;
};

/// Nodes that move with elements they are no corners of.
struct NodeTie {
  static constexpr std::string_view name = "tie";
  static constexpr std::string_view summary =
      "nodes move with the elements that they are inside, or on the faces of, without being their corners: "
      "where meshes that do not match meet; not with [[refine]]";

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
  Vector axis{};                 ///< of length one; turns by the right-hand rule
  double angle = 0.0;            ///< final angle, rad
  std::optional<Vector> center;  ///< a point of the axis, m; else the mean of the nodes' positions
  Vector displacement{};         ///< final displacement in addition to the rotation, m
};

/// Velocities in which nodes start; what several say of one node adds up.
struct InitialVelocity {
  static constexpr std::string_view name = "velocity";
  static constexpr std::string_view summary = "where a dynamic answer starts; several add up";
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
                  "on each axis, of a wave that stands between the free ends of the set: value times "
                  "cos(pi half_waves (x - low) / (high - low))",
                  false},
        Parameter{&V::spin, "spin", "rad/s", Range::any(), "about the centre of mass of the set", false}};
  }
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

}  // namespace sandglass
