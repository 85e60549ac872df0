#include "problem/model.hpp"

#include "problem/masses.hpp"

namespace sandglass {

Model::Model(const Scene& scene, MethodChoice choice)
    : scene_(scene),
      choice_(std::move(choice)),
      internal_force_(make_internal_force(scene.mesh, scene.materials, choice_)),
      element_masses_(sandglass::element_masses(scene.mesh, scene.materials)),
      masses_(lumped_masses(scene.mesh, element_masses_)) {}

NodalField internal_forces(const Model& model, const NodalField& u) {
  return std::visit(
      [&]<class Real>(const std::unique_ptr<InternalForce<Real>>& elements) {
        State<Real> state = state_at(*elements, u);
        Rows<Real> force(state.u.size());
        elements->evaluate(state, force);
        return to_field(force, elements->layout());
      },
      model.internal_force());
}

StrainEnergies strain_energies(const Model& model, const NodalField& u) {
  return std::visit(
      [&]<class Real>(const std::unique_ptr<InternalForce<Real>>& elements) {
        State<Real> state = state_at(*elements, u);
        Rows<Real> unused(state.u.size());
        elements->evaluate(state, unused);  // takes along what elements remember
        return elements->energies(state);
      },
      model.internal_force());
}

}  // namespace sandglass
