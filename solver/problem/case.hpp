#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "assembly/internal_force.hpp"
#include "element/hourglass_settings.hpp"
#include "material/laws.hpp"
#include "mesh/generators.hpp"
#include "mesh/node_set.hpp"
#include "problem/settings.hpp"

namespace sandglass {

/// A mesh read from a file, as `sandglass mesh` writes it.
struct MeshFile {
  std::filesystem::path path;
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
  Vector displacement{};         ///< final displacement beside the rotation, m
};

/// A dead load on the boundary faces within a node set; it follows the loading curve.
struct ImposedForce {
  std::string set;
  Vector total{};   ///< final sum, N
  Vector moment{};  ///< final moment about the centroid of the faces, N m
};

/// Velocities in which nodes start; what several say of one node adds up.
struct InitialVelocity {
  std::optional<std::string> set = {};  ///< none: the whole body
  Vector value{};                       ///< m/s
  std::array<int, 3> half_waves{};  ///< of a standing wave between the free ends of the set, on each axis:
                                    ///< value times cos(pi half_waves (x - low) / (high - low))
  Vector spin{};                    ///< rad/s, about the centre of mass of the set
};

/// A motion of a node set that somebody published.
struct PublishedValue {
  std::string set;
  std::string component;  ///< "x", "y", "z": mean displacement; "around-x", ...: mean rotation
  double value = 0.0;     ///< m or rad; not zero
  std::string source;     ///< who says so
};

/// A line of nodes along which displacements are plotted and compared, as in the paper's figures 2 and 4.
struct Profile {
  std::string set;
  std::string
      order;  ///< "x", "y", "z" along an axis; "around-x", ... by angle about an axis through the centroid
};

/// A limit that `sandglass verify` holds a method to.
struct Expectation {
  std::string method;
  std::string kappa = "auto";   ///< a number, "auto", or "best": the smallest figure over the case's kappas
  std::string reference;        ///< "golden", "truth" or "published"
  std::string figure;           ///< "max_relative_error", "profile_relative_error" or "rms_relative_error";
                                ///< "relative_error" of published values
  std::optional<double> below;  ///< the figure must be at most this, fraction
  std::optional<double> above;  ///< the figure must be more than this: the method must fail visibly
  std::string reason;
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
  AnyLaw law;
  double density = 0.0;  ///< kg/m^3
  std::vector<NodeSetRule> sets;
  std::vector<ImposedDisplacement> displacements;
  std::vector<ImposedRotation> rotations;
  std::vector<ImposedForce> forces;
  std::vector<InitialVelocity> velocities;
  std::optional<Profile> profile;
  RelaxationSettings relaxation;
  DynamicsSettings dynamics;
  std::optional<MethodChoice> method;  ///< what `sandglass run` takes unless told otherwise
  std::vector<double> kappas;          ///< the curve that `sandglass verify` computes beside `auto`
  std::vector<Expectation> expectations;
  std::vector<PublishedValue> published;
  std::filesystem::path golden;
  std::filesystem::path truth;
};

/// A hash of what decides the static answer: mesh recipe, law, node sets, imposed displacements,
/// rotations and forces. Method, settings, limits, published values and words do not enter.
std::string case_hash(const Case& scene);

}  // namespace sandglass
