#include "mesh/mesh_part.hpp"

namespace sandglass {

MeshPart part_of_mesh(const Mesh& mesh, const std::vector<bool>& marked) {
  const std::size_t nodes = mesh.points.size();
  std::vector<bool> inside(nodes, false), outside(nodes, false);
  MeshPart part;
  for (std::size_t e = 0; e < mesh.cells.size(); ++e) {
    if (marked[e]) part.element_of.push_back(static_cast<int>(e));
    for (const int node : mesh.cells[e]) (marked[e] ? inside : outside)[at(node)] = true;
  }
  part.part_of.assign(nodes, -1);
  for (std::size_t n = 0; n < nodes; ++n) {
    if (!inside[n]) continue;
    part.part_of[n] = static_cast<int>(part.node_of.size());
    part.node_of.push_back(static_cast<int>(n));
    part.mesh.points.push_back(mesh.points[n]);
    part.on_the_rim.push_back(outside[n]);
  }
  for (const int e : part.element_of) {
    Hexahedron cell = mesh.cells[at(e)];
    for (int& node : cell) node = part.part_of[at(node)];
    part.mesh.cells.push_back(cell);
  }
  return part;
}

}  // namespace sandglass
