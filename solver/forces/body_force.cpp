#include "forces/body_force.hpp"

#include <algorithm>

#include "forces/face_forces.hpp"

namespace sandglass {

std::vector<FaceForces> BodyForce::face_forces() const {
  return {};
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
