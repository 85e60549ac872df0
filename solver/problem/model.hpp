#pragma once

#include <vector>

#include "assembly/internal_force.hpp"
#include "problem/scene.hpp"

namespace sandglass {

/// A well-posed problem: scene, elements and masses. Everything is const; the state is in the steppers.
class Model {
 public:
  Model(const Scene& scene, MethodChoice choice);

  const Scene& scene() const { return scene_; }
  const MethodChoice& choice() const { return choice_; }
  const AnyInternalForce& internal_force() const { return internal_force_; }

  /// Lumped masses of the nodes, with what is attached to them, kg; the mass of a tied node is added to the
  /// nodes that it follows.
  const std::vector<double>& masses() const { return masses_; }

  /// Mass of each element, kg.
  const std::vector<double>& element_masses() const { return element_masses_; }

  /// The share of the forces in the frequencies of each element; empty if there is none.
  const std::vector<LoadRates>& load_rates() const { return load_rates_; }

 private:
  const Scene& scene_;
  MethodChoice choice_;
  AnyInternalForce internal_force_;
  std::vector<double> element_masses_;
  std::vector<double> masses_;
  std::vector<LoadRates> load_rates_;
};

/// The elements of a model in double precision.
inline const InternalForce<double>& double_elements(const Model& model) {
  return *std::get<std::unique_ptr<InternalForce<double>>>(model.internal_force());
}

/// Internal nodal forces (N) of a model at displacements u (m), reached in one step.
NodalField internal_forces(const Model& model, const NodalField& u);

/// Energies of a model at displacements u (m), reached in one step.
StrainEnergies strain_energies(const Model& model, const NodalField& u);

}  // namespace sandglass
