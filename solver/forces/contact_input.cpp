#include "forces/contact_input.hpp"

#include <algorithm>

#include "base/error.hpp"
#include "forces/contact_force.hpp"
#include "mesh/edges.hpp"

namespace sandglass {

ContactScale::ContactScale(const ForceResolver& resolver, const std::vector<Quadrilateral>& faces) {
  std::vector<bool> touches(resolver.points.size(), false);
  for (const int node : nodes_of(faces)) touches[at(node)] = true;
  for (std::size_t e = 0; e < resolver.cells.size(); ++e) {
    const Hexahedron& cell = resolver.cells[e];
    if (std::ranges::count_if(cell, [&](int node) { return touches[at(node)]; }) < 4) continue;
    modulus = std::min(modulus, resolver.young_moduli[e]);
    for (const auto& [a, b] : hexahedron_edges)
      edge = std::min(edge, distance(resolver.points[at(cell[a])], resolver.points[at(cell[b])]));
  }
}

void require_own_name(const ForceResolver& resolver, std::string_view table, const std::string& label) {
  const auto refuse = [&](const std::string& other) {
    throw InputError(
        fmt::format("{}: {} '{}': {} has the same name, and forces are reported by name; "
                    "allowed: a name of its own",
                    resolver.file, table, label, other));
  };
  if (resolver.sets.contains(label)) refuse("a node set");
  for (const ContactForce* other : contacts_of(resolver.forces)) {
    if (other->touch(std::vector<Row<double>>(other->memory()).data()).name == label)
      refuse(fmt::format("another {}", other->traits().name));
  }
}

void refuse_node(const ForceResolver& resolver, std::string_view table, const std::string& label, int node,
                 const std::string& what, const std::string& allowed) {
  const Vector& X = resolver.points[at(node)];
  throw InputError(fmt::format("{}: {} '{}': node {} at ({:.6g}, {:.6g}, {:.6g}) m {}; allowed: {}",
                               resolver.file, table, label, node, X[0], X[1], X[2], what, allowed));
}

std::optional<BrokenRule> broken_rule_of_name(const std::string& label) {
  if (!label.empty() && label.find('/') == std::string::npos) return std::nullopt;
  return BrokenRule{"name", fmt::format("= '{}' must be a word without '/'", label)};
}

}  // namespace sandglass
