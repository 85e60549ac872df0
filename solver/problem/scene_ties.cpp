#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "base/error.hpp"
#include "mesh/hexahedron.hpp"
#include "mesh/interpolation.hpp"
#include "problem/scene_rules.hpp"

namespace sandglass {

namespace {

/// How far outside an element a node may be, as a share of half its size: the roundoff of mesh generators.
constexpr double tolerance = 1e-6;

[[noreturn]] void refuse(const Scene& scene, const NodeTie& rule, int node, const std::string& what) {
  const Vector& X = scene.mesh.points[at(node)];
  throw InputError(fmt::format("{}: tie.set = '{}': the node {} at ({}, {}, {}) m {}",
                               scene.settings.file.string(), rule.set, node, X[0], X[1], X[2], what));
}

/// The corners that a point of an element follows. Points on a face follow only the corners of that face.
std::vector<Tie::Share> shares_of(const Hexahedron& cell, Vector parent) {
  for (double& xi : parent)
    if (std::abs(xi) > 1.0 - tolerance) xi = std::copysign(1.0, xi);
  const auto N = shape_functions(parent);
  std::vector<Tie::Share> shares;
  for (std::size_t I = 0; I < N.size(); ++I)
    if (N[I] > 0.0) shares.push_back({cell[I], N[I]});
  return shares;
}

void add_ties(const Scene& scene, const NodeTie& rule, std::map<int, Tie>& ties) {
  Mesh mesh{scene.mesh.points, {}};
  std::vector<bool> is_corner(mesh.points.size(), false);
  for (const int e : element_set(scene, "tie.elements", rule.elements)) {
    mesh.cells.push_back(scene.mesh.cells[at(e)]);
    for (const int node : mesh.cells.back()) is_corner[at(node)] = true;
  }
  std::vector<int> nodes;
  NodalField points;
  for (const int node : node_set(scene, "tie.set", rule.set)) {
    if (is_corner[at(node)]) continue;
    nodes.push_back(node);
    points.push_back(mesh.points[at(node)]);
  }
  const auto is_driven = [&](int node) {
    return std::ranges::binary_search(scene.constraints, node, {}, &Constraint::node);
  };
  const auto places = element_points(mesh, points);
  for (std::size_t n = 0; n < nodes.size(); ++n) {
    const auto& [element, parent] = places[n];
    if (parent_distance(parent) > 1.0 + tolerance)
      refuse(scene, rule, nodes[n],
             fmt::format("is outside all elements of '{}'; it must be in one", rule.elements));
    if (is_driven(nodes[n]))
      refuse(scene, rule, nodes[n],
             "is also driven; a tied node follows only the elements; allowed: a set without driven nodes");
    Tie tie{nodes[n], shares_of(mesh.cells[element], parent)};
    if (!ties.emplace(nodes[n], std::move(tie)).second)
      refuse(scene, rule, nodes[n], "is tied by two tables; allowed: one");
  }
}

}  // namespace

void tie(const Case& description, Scene& scene) {
  if (description.ties.empty()) return;
  if (!description.refinements.empty()) {
    throw InputError(fmt::format("{}: tie: a mesh with tied parts cannot be refined; leave out refine",
                                 description.file.string()));
  }
  std::map<int, Tie> ties;
  for (const NodeTie& rule : description.ties) add_ties(scene, rule, ties);
  for (auto& [node, tie] : ties) scene.ties.push_back(std::move(tie));
  scene.ties = to_free_nodes(scene.ties);
}

}  // namespace sandglass
