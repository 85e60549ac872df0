#include "forces/dead_loads.hpp"

#include "base/error.hpp"

namespace sandglass {

namespace {

std::vector<int> nodes_of(const std::vector<NodalLoad>& loads) {
  std::vector<int> nodes;
  for (const NodalLoad& load : loads) nodes.push_back(load.node);
  return nodes;
}

}  // namespace

DeadLoads::DeadLoads(std::vector<NodalLoad> loads, std::vector<LoadSize> sizes,
                     std::optional<std::vector<SlopesOfLoad>> slopes)
    : BodyForce(nodes_of(loads), {"force", true, false, ""}),
      loads_(std::move(loads)),
      sizes_(std::move(sizes)),
      slopes_(std::move(slopes)) {}

void DeadLoads::add_forces(Factors factors, const NodalMotion& /*motion*/,
                           AtNodes<Row<double>> forces) const {
  for (const auto& [node, force, curve] : loads_) {
    for (std::size_t i = 0; i < 3; ++i) forces[node][i] += factors[curve] * force[i];
  }
}

void DeadLoads::add_potential(Factors factors, NodalRows u, double& sum) const {
  for (const auto& [node, force, curve] : loads_)
    sum -= factors[curve] * (force[0] * u[node][0] + force[1] * u[node][1] + force[2] * u[node][2]);
}

void DeadLoads::add_slopes(Factors factors, const ShapeSlopes& shape) const {
  if (!slopes_) throw InputError("derivatives: loads on a part of a body have none by positions of nodes");
  for (const SlopesOfLoad& add : *slopes_) add(factors, shape);
}

void DeadLoads::add_size(double arm, double& sum) const {
  for (const auto& [force, moment] : sizes_) sum += force + moment / arm;
}

std::shared_ptr<const BodyForce> DeadLoads::restricted_to(const MeshPart& part) const {
  std::vector<NodalLoad> loads;
  for (const auto& [node, force, curve] : loads_) {
    const int there = part.part_of[at(node)];
    if (there >= 0) loads.push_back({there, force, curve});
  }
  return loads.empty() ? nullptr : std::make_shared<DeadLoads>(std::move(loads), sizes_);
}

}  // namespace sandglass
