#include "forces/dead_loads.hpp"

#include <algorithm>
#include <cmath>

namespace sandglass {

namespace {

std::vector<int> nodes_of(const std::vector<NodalLoad>& loads) {
  std::vector<int> nodes;
  for (const NodalLoad& load : loads) nodes.push_back(load.node);
  return nodes;
}

}  // namespace

DeadLoads::DeadLoads(std::vector<NodalLoad> loads, const LoadSize& size)
    : BodyForce(nodes_of(loads), {"force", true, false, ""}), loads_(std::move(loads)), size_(size) {
  for (const NodalLoad& load : loads_) places_.push_back(place_of(load.node));
}

void DeadLoads::add_forces(std::span<const double> factors, const NodalMotion& /*motion*/,
                           AtNodes<Row<double>> forces) const {
  for (std::size_t k = 0; k < loads_.size(); ++k) {
    const double factor = factors[loads_[k].curve];
    for (std::size_t i = 0; i < 3; ++i) forces[places_[k]][i] += factor * loads_[k].force[i];
  }
}

void DeadLoads::add_potential(std::span<const double> factors, AtNodes<const Row<double>> u,
                              double& sum) const {
  for (std::size_t k = 0; k < loads_.size(); ++k) {
    const Vector& f = loads_[k].force;
    const Row<double>& moved = u[places_[k]];
    sum -= factors[loads_[k].curve] * (f[0] * moved[0] + f[1] * moved[1] + f[2] * moved[2]);
  }
}

void DeadLoads::add_size(LoadSize& size) const {
  size.force += size_.force;
  size.moment += size_.moment;
}

std::shared_ptr<const BodyForce> DeadLoads::restricted_to(const MeshPart& part) const {
  std::vector<NodalLoad> loads;
  for (const auto& [node, force, curve] : loads_) {
    const int there = part.part_of[at(node)];
    if (there >= 0) loads.push_back({there, force, curve});
  }
  return loads.empty() ? nullptr : std::make_shared<DeadLoads>(std::move(loads), size_);
}

std::shared_ptr<const BodyForce> DeadLoads::held_at(std::span<const double> factors) const {
  std::vector<NodalLoad> loads = loads_;
  double largest = 0.0;
  for (auto& [node, force, curve] : loads) {
    for (double& f : force) f *= factors[curve];
    largest = std::max(largest, std::abs(factors[curve]));
    curve = 0;
  }
  return std::make_shared<DeadLoads>(std::move(loads),
                                     LoadSize{largest * size_.force, largest * size_.moment});
}

}  // namespace sandglass
