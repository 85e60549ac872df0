#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "model/case.hpp"
#include "model/internal_force.hpp"

namespace sandglass {

/// One imposed displacement component.
struct Constraint {
  int node;
  int component;
  double value;  ///< final value, m
};

/// The mesh of a case with its node sets; shared by all methods.
struct Scene {
  Case description;
  Mesh mesh;
  NodeSets sets;
  std::vector<Constraint> constraints;  ///< sorted by node, then component
  std::string case_hash;
  std::string mesh_hash;
};

/// Node sets by their rules, constraints from the imposed displacements. Throws InputError for an inverted
/// element, an empty set, and a node to which two different values are imposed.
Scene make_scene(Case description, Mesh mesh, NodeSets sets_of_file = {});

/// The mesh of a case whose mesh comes from a generator.
Mesh generate_mesh(const AnyGenerator& generator);

/// Largest imposed displacement, m: the unit of all relative errors.
double largest_imposed(const Scene& scene);

/// What the user chooses beside the case.
struct MethodChoice {
  std::string method;
  std::optional<double> kappa;  ///< none means auto
};

/// A well-posed problem: scene, elements and masses. All is const; what changes lives in the steppers' state.
class Model {
 public:
  Model(const Scene& scene, MethodChoice choice);

  const Scene& scene() const { return scene_; }
  const MethodChoice& choice() const { return choice_; }
  const InternalForce& internal_force() const { return *internal_force_; }

  /// Lumped masses (kg): an eighth of rho V of each element at each of its nodes.
  const std::vector<double>& masses() const { return masses_; }

  /// Mass of each element, kg.
  const std::vector<double>& element_masses() const { return element_masses_; }

  /// Sets the constrained components of `u` to `factor` times their final value.
  void impose(double factor, NodalField& u) const;

  /// Sets the constrained components of `field` to zero.
  void clear_constrained(NodalField& field) const;

 private:
  const Scene& scene_;
  MethodChoice choice_;
  std::unique_ptr<InternalForce> internal_force_;
  std::vector<double> element_masses_;
  std::vector<double> masses_;
};

}  // namespace sandglass
