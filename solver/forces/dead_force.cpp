#include "forces/dead_force.hpp"

namespace sandglass {

std::optional<BrokenRule> DeadForce::broken_rule() const {
  if (on == Carrier::faces || moment == Vector{}) return std::nullopt;
  return BrokenRule{"moment", "acts on faces and cannot have on = 'nodes'"};
}

void DeadForce::resolve(ForceResolver& resolver) const {
  resolver.sizes_of_dead.push_back({length(total), length(moment)});
  if (on == Carrier::nodes) {
    const auto& nodes = resolver.nodes(name, set);
    const std::size_t number = resolver.number_of(curve);
    for (const int node : nodes)
      resolver.add_dead(number, node, total, 1.0 / static_cast<double>(nodes.size()));
    return;
  }
  const auto faces = resolver.faces(name, set);
  const std::size_t number = resolver.number_of(curve);
  for (const auto& load : consistent_loads(resolver.points, faces, total, moment))
    resolver.add_dead(number, load.node, load.force, 1.0);
  resolver.slopes_of_dead.push_back([=, F = total, M = moment](Factors factors, const ShapeSlopes& shape) {
    add_slopes_of_loads(factors[number], shape.points, faces, F, M, shape.v, shape.by_points);
  });
}

}  // namespace sandglass
