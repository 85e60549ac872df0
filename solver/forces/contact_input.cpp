#include "forces/contact_input.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>

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

int node_within_other_body(const ForceResolver& resolver, const std::vector<Quadrilateral>& surface,
                           const std::vector<Quadrilateral>& other) {
  std::vector<int> body(resolver.points.size());  // of nodes, by one of its nodes
  std::iota(body.begin(), body.end(), 0);
  const auto body_of = [&](int node) {
    while (body[at(node)] != node) node = body[at(node)] = body[at(body[at(node)])];
    return node;
  };
  for (const Hexahedron& cell : resolver.cells) {
    for (const int node : cell) body[at(body_of(node))] = body_of(cell[0]);
  }
  std::vector<bool> is_other(resolver.points.size(), false);
  for (const int node : nodes_of(other)) is_other[at(body_of(node))] = true;
  for (const int node : nodes_of(surface)) is_other[at(body_of(node))] = false;
  std::vector<Quadrilateral> faces;
  Vector low{INFINITY, INFINITY, INFINITY}, high{-INFINITY, -INFINITY, -INFINITY};
  for (const Quadrilateral& face : resolver.boundary) {
    if (!is_other[at(body_of(face[0]))]) continue;
    faces.push_back(face);
    for (const int node : face) {
      for (std::size_t i = 0; i < 3; ++i) {
        low[i] = std::min(low[i], resolver.points[at(node)][i]);
        high[i] = std::max(high[i], resolver.points[at(node)][i]);
      }
    }
  }
  std::vector<bool> on_surface(resolver.points.size(), false);
  for (const int node : nodes_of(surface)) on_surface[at(node)] = true;
  for (const Hexahedron& cell : resolver.cells) {
    const Vector middle = mean_at(cell, resolver.points);
    for (const int node : cell) {
      if (!on_surface[at(node)]) continue;
      on_surface[at(node)] = false;
      constexpr double inwards = 1e-3;
      const Vector& X = resolver.points[at(node)];
      const Vector x = sum(X, inwards, difference(middle, X));
      bool near = true;
      for (std::size_t i = 0; i < 3; ++i) near = near && x[i] > low[i] && x[i] < high[i];
      if (near && winding_number(x, faces, resolver.points) > 0.5) return node;
    }
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
