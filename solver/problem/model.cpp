#include "problem/model.hpp"

#include <algorithm>
#include <cmath>

#include "problem/masses.hpp"

namespace sandglass {

namespace {

/// At each node stiffness and damping over the mass; of an element the largest of its nodes. Springs are at
/// most as stiff as if each node had its share of the area for itself.
///
/// A pressure p on a face with edges along xi and eta has the tangent p times the integral of N_I (dN_J/dxi x
/// dx/deta - ...), whose norm is at most p times half the sum of two edges, as those of the integrals of N_I
/// dN_J/dxi are 1 and |dx/deta| is at most half the longer edge.
std::vector<Model::LoadRates> load_rates_of(const Scene& scene, const std::vector<double>& element_masses) {
  if (scene.pressures.empty() && scene.supports.empty()) return {};
  const std::vector<double> masses = lumped_masses(scene.mesh, element_masses);
  std::vector<Model::LoadRates> at_nodes(masses.size());
  const double end = scene.description.quasi_static ? 1.0 : scene.description.dynamics.duration;
  for (const FacePressure& pressure : scene.pressures) {
    const Quadrilateral& face = pressure.face;
    const double most = std::abs(pressure.pressure) * scene.curves[pressure.curve].largest(end);
    double edges = 0.0;
    for (std::size_t I = 0; I < 2; ++I) {
      const auto edge = [&](std::size_t a, std::size_t b) {
        return distance(scene.mesh.points[at(face[a])], scene.mesh.points[at(face[b])]);
      };
      edges += std::max(edge(I, I + 1), edge(I + 2, (I + 3) % 4));
    }
    for (const int node : face) {
      const auto n = at(node);
      at_nodes[n].square += 0.5 * edges * most / masses[n];
    }
  }
  for (const auto& support : scene.supports) {
    for (const auto& point : gauss_points_of(corners_of(scene.mesh.points, support.face))) {
      for (std::size_t I = 0; I < 4; ++I) {
        const auto n = at(support.face[I]);
        at_nodes[n].square += support.stiffness * point.N[I] * point.area / masses[n];
        at_nodes[n].damping += support.damping * point.N[I] * point.area / masses[n];
      }
    }
  }
  std::vector<Model::LoadRates> rates(scene.mesh.cells.size());
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
      masses_(handed_on(scene.ties, lumped_masses(scene.mesh, element_masses_))),
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
        elements->evaluate(state, unused);  // takes along what elements remember
        return elements->energies(state);
      },
      model.internal_force());
}

}  // namespace sandglass
