#include "problem/masses.hpp"

#include "mesh/hexahedron.hpp"

namespace sandglass {

std::vector<double> element_masses(const Mesh& mesh, const Materials& materials) {
  std::vector<double> masses;
  masses.reserve(mesh.cells.size());
  for (std::size_t e = 0; e < mesh.cells.size(); ++e) {
    const double density = materials.list[materials.of(e)].density;
    masses.push_back(density * mean_gradient(gather(mesh.points, mesh.cells[e])).volume);
  }
  return masses;
}

std::vector<double> lumped_masses(const Mesh& mesh, const std::vector<double>& element_masses,
                                  std::vector<double> attached) {
  std::vector<double> masses = std::move(attached);
  masses.resize(mesh.points.size());
  for (std::size_t e = 0; e < mesh.cells.size(); ++e) {
    for (const int node : mesh.cells[e]) masses[at(node)] += share_of_node(element_masses[e]);
  }
  return masses;
}

}  // namespace sandglass
