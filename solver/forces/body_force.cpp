#include "forces/body_force.hpp"

#include <algorithm>

namespace sandglass {

BodyForce::BodyForce(std::vector<int> nodes, const ForceTraits& traits)
    : nodes_(std::move(nodes)), traits_(traits) {
  std::sort(nodes_.begin(), nodes_.end());
  nodes_.erase(std::unique(nodes_.begin(), nodes_.end()), nodes_.end());
}

std::size_t BodyForce::place_of(int node) const {
  return static_cast<std::size_t>(std::lower_bound(nodes_.begin(), nodes_.end(), node) - nodes_.begin());
}

std::array<std::size_t, 4> BodyForce::places_of(const Quadrilateral& face) const {
  return {place_of(face[0]), place_of(face[1]), place_of(face[2]), place_of(face[3])};
}

const BodyForce* first_not_dead(const BodyForces& forces) {
  for (const auto& force : forces) {
    if (force->dead_loads().empty()) return force.get();
  }
  return nullptr;
}

std::vector<NodalLoad> dead_loads(const BodyForces& forces) {
  std::vector<NodalLoad> all;
  for (const auto& force : forces) {
    const auto loads = force->dead_loads();
    all.insert(all.end(), loads.begin(), loads.end());
  }
  return all;
}

std::vector<Quadrilateral> faces_in(const MeshPart& part, const std::vector<Quadrilateral>& faces) {
  std::vector<Quadrilateral> inside;
  for (Quadrilateral face : faces) {
    for (int& node : face) node = part.part_of[at(node)];
    if (*std::min_element(face.begin(), face.end()) >= 0) inside.push_back(face);
  }
  return inside;
}

std::vector<int> nodes_of(const std::vector<Quadrilateral>& faces) {
  std::vector<int> nodes;
  for (const Quadrilateral& face : faces) nodes.insert(nodes.end(), face.begin(), face.end());
  return nodes;
}

}  // namespace sandglass
