#include "problem/model.hpp"

#include <algorithm>
#include <cmath>

#include "problem/masses.hpp"

namespace sandglass {

namespace {

/// The largest value at the nodes of each element.
std::vector<LoadRates> load_rates_of(const Scene& scene, const std::vector<double>& element_masses) {
  if (first_not_dead(scene.forces) == nullptr) return {};
  const std::vector<double> masses = lumped_masses(scene.mesh, element_masses, scene.attached_masses);
  const double end = scene.settings.quasi_static ? 1.0 : scene.settings.dynamics.duration;
  std::vector<double> largest;
  for (const LoadCurve& curve : scene.curves) largest.push_back(curve.largest(end));
  std::vector<LoadRates> at_nodes(masses.size());
  for (const auto& force : scene.forces) force->add_rates(largest, masses, at_nodes);
  std::vector<LoadRates> rates(scene.mesh.cells.size());
  for (std::size_t e = 0; e < rates.size(); ++e) {
    for (const int node : scene.mesh.cells[e]) {
      const auto& [square, damping] = at_nodes[at(node)];
      rates[e].square = std::max(rates[e].square, square);
      rates[e].damping = std::max(rates[e].damping, damping);
    }
  }
  return rates;
}

}  // namespace

Model::Model(const Scene& scene, MethodChoice choice)
    : scene_(scene),
      choice_(std::move(choice)),
      internal_force_(make_internal_force(scene.mesh, scene.materials, choice_)),
      element_masses_(sandglass::element_masses(scene.mesh, scene.materials)),
      masses_(handed_on(scene.ties, lumped_masses(scene.mesh, element_masses_, scene.attached_masses))),
      load_rates_(load_rates_of(scene, element_masses_)) {}

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
        elements->evaluate(state, unused);  // updates the history of the elements
        return elements->energies(state);
      },
      model.internal_force());
}

}  // namespace sandglass
