#include "forces/point_mass.hpp"

namespace sandglass {

void PointMass::resolve(ForceResolver& resolver) const {
  const auto& nodes = resolver.nodes(name, set);
  const double share = total / static_cast<double>(nodes.size());
  resolver.attached.resize(resolver.masses.size());
  for (const int node : nodes) {
    resolver.masses[at(node)] += share;
    resolver.attached[at(node)] += share;
  }
}

}  // namespace sandglass
