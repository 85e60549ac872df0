#pragma once

#include <map>
#include <string>
#include <vector>

#include "base/parameter.hpp"
#include "io/mesh_file.hpp"
#include "sandglass/simulation.hpp"

/// Common parts of simulations and batches.
namespace sandglass {

template <class Real>
inline constexpr Precision precision_of =
    std::is_same_v<Real, double> ? Precision::double_precision : Precision::single_precision;

/// Throws InputError, with this name, if the value is out of range.
void require_in_range(const char* name, double value, const Range& range);

/// A program's arrays as a mesh with sorted sets. Throws InputError if a cell or set names an unknown node or
/// element, if a node belongs to no cell or has no finite position, and if there are no nodes.
MeshWithSets checked(MeshArrays arrays);

/// The number of equal steps of at most `step` (s) in a time (s); n for a time of n times `step`. Throws
/// InputError for more than can be counted.
double steps_in(double seconds, double step);

/// A driven component of a set, or of an obstacle.
struct Driven {
  std::size_t constraint;  ///< index into the constraints of the scene; beyond, components of obstacles
  std::size_t node;        ///< index into the nodes of the set
  std::size_t component;
};

/// A case with a method and the sets that a program drives; immutable.
class DrivenProblem {
 public:
  /// Throws InputError for settings out of range and for a method without steps.
  DrivenProblem(Scene scene, const SimulationSettings& settings, Precision precision);

  const Scene& scene() const { return scene_; }
  const Model& model() const { return model_; }
  double damping() const { return damping_; }  ///< 1/s
  double step_fraction() const { return step_fraction_; }

  /// A step (s), or the time step of the case, which is the longest if it is given.
  double longest_step(double step) const {
    const double given = scene_.settings.dynamics.time_step;
    return given > 0.0 ? std::min(step, given) : step;
  }

  /// The number of driven components: constraints, then three for each obstacle.
  std::size_t targets() const { return targets_; }

  /// The driven components of a set or an obstacle. Throws InputError for a set without any, and lists the
  /// driven sets.
  const std::vector<Driven>& driven(const std::string& set) const;

  /// Throws InputError for an unknown set.
  const std::vector<int>& nodes(const std::string& set) const;

  /// Throws InputError unless `count` is the number of nodes of a set.
  void require_one_for_each_node(const std::string& set, std::size_t count) const;

  /// Calls set(constraint, u) for the driven components of a set, with u (m) from `displacement(n)` for the
  /// n-th node of the set. First throws InputError if any number is not finite.
  template <class Displacement, class Set>
  void move(const std::string& name, const Displacement& displacement, const Set& set) const {
    const std::vector<Driven>& components = driven(name);
    for (const auto& [constraint, node, component] : components) {
      require_in_range("displacement", displacement(node)[component], Range::any());
    }
    for (const auto& [constraint, node, component] : components) {
      set(constraint, displacement(node)[component]);
    }
  }

  /// Calls set(constraint, u) with the case's displacements (m) of driven components at a load factor.
  template <class Set>
  void impose(double factor, const Set& set) const {
    require_in_range("factor", factor, Range::any());
    for (std::size_t k = 0; k < scene_.constraints.size(); ++k) {
      const ImposedPath& path = scene_.constraints[k].path;
      set(k, path.along(path_terms(scene_.angles[path.angle], factor)));
    }
  }

 private:
  const Scene scene_;
  const Model model_;
  const std::map<std::string, std::vector<Driven>> driven_;
  const std::size_t targets_;
  double damping_;
  double step_fraction_;
};

}  // namespace sandglass
