#include "forces/contact_input.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "base/error.hpp"
#include "forces/contact_force.hpp"
#include "mesh/disjoint_sets.hpp"
#include "mesh/edges.hpp"
#include "mesh/interpolation.hpp"

namespace sandglass {

ContactScale::ContactScale(const NodalField& points, std::span<const Hexahedron> cells,
                           const std::vector<double>& young_moduli, const std::vector<Quadrilateral>& faces) {
  std::vector<bool> touches(points.size(), false);
  for (const int node : nodes_of(faces)) touches[at(node)] = true;
  for (std::size_t e = 0; e < cells.size(); ++e) {
    const Hexahedron& cell = cells[e];
    if (std::ranges::count_if(cell, [&](int node) { return touches[at(node)]; }) < 4) continue;
    modulus = std::min(modulus, young_moduli[e]);
    for (const auto& [a, b] : hexahedron_edges)
      edge = std::min(edge, distance(points[at(cell[a])], points[at(cell[b])]));
  }
}

double winding_number(const Vector& x, const std::vector<Quadrilateral>& faces, const NodalField& points) {
  double angle = 0.0;
  for (const Quadrilateral& face : faces) {
    const auto X = corners_of(points, face);
    for (const std::size_t k : {1U, 2U}) {  // two triangles
      const Vector a = difference(X[0], x), b = difference(X[k], x), c = difference(X[k + 1], x);
      const double A = length(a), B = length(b), C = length(c);
      angle +=
          2.0 * std::atan2(dot(a, cross(b, c)), A * B * C + dot(a, b) * C + dot(a, c) * B + dot(b, c) * A);
    }
  }
  return angle / (4.0 * std::numbers::pi);
}

int node_within_body(const ForceResolver& resolver, const std::vector<Quadrilateral>& surface,
                     const std::vector<Quadrilateral>& other) {
  DisjointSets bodies(resolver.points.size());
  for (const Hexahedron& cell : resolver.cells) {
    for (const int node : cell) bodies.join(cell[0], node);
  }
  std::vector<bool> has_other(resolver.points.size(), false);
  for (const int node : nodes_of(other)) has_other[at(bodies.least(node))] = true;
  constexpr double just_within = 1e-3;
  constexpr double deep_within = 0.3;  // edges of curved surfaces may cut into each other
  for (const auto& [line, element] :
       overlaps(resolver.points, resolver.cells, nodes_of(surface), just_within, deep_within)) {
    if (has_other[at(bodies.least(resolver.cells[element][0]))]) return line.nodes[0];
  }
  return -1;
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
