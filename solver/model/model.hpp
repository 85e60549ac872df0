#pragma once

#include <memory>
#include <string>
#include <vector>

#include "mesh/face_load.hpp"
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
  std::vector<NodalLoad> loads;         ///< final forces, sorted by node
  std::string case_hash;
  std::string mesh_hash;
};

/// Node sets by their rules, constraints from the imposed displacements, loads from the imposed forces.
/// Throws InputError for an inverted element, an empty set, a node to which two different values are imposed,
/// and a force on a set without boundary faces.
Scene make_scene(Case description, Mesh mesh, NodeSets sets_of_file = {});

/// The mesh of a case whose mesh comes from a generator.
Mesh generate_mesh(const AnyGenerator& generator);

/// Largest imposed displacement, m; zero when the case is driven by forces alone.
double largest_imposed(const Scene& scene);

/// The unit of all relative errors against a reference (m): the largest imposed displacement; where none is
/// imposed, the reference's own largest.
double displacement_unit(const Scene& scene, const NodalField& reference);

/// A well-posed problem: scene, elements and masses. All is const; what changes lives in the steppers' state.
class Model {
 public:
  Model(const Scene& scene, MethodChoice choice);

  const Scene& scene() const { return scene_; }
  const MethodChoice& choice() const { return choice_; }
  const AnyInternalForce& internal_force() const { return internal_force_; }

  /// Lumped masses (kg): an eighth of rho V of each element at each of its nodes.
  const std::vector<double>& masses() const { return masses_; }

  /// Mass of each element, kg.
  const std::vector<double>& element_masses() const { return element_masses_; }

 private:
  const Scene& scene_;
  MethodChoice choice_;
  AnyInternalForce internal_force_;
  std::vector<double> element_masses_;
  std::vector<double> masses_;
};

/// Internal nodal forces (N) of a model at displacements u (m), reached from rest in one step.
NodalField internal_forces(const Model& model, const NodalField& u);

/// Energies of a model at displacements u (m), reached from rest in one step.
StrainEnergies strain_energies(const Model& model, const NodalField& u);

}  // namespace sandglass
