#include "mesh/node_set.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/error.hpp"
#include "base/names.hpp"
#include "mesh/edges.hpp"

namespace sandglass {

namespace {

bool inside(const CylinderRegion& region, const Vector& point, double tolerance) {
  const std::size_t first = region.axis == 0 ? 1 : 0;
  const std::size_t second = region.axis == 2 ? 1 : 2;
  const double a = (point[first] - region.center[0]) / (region.semi_axes[0] + tolerance);
  const double b = (point[second] - region.center[1]) / (region.semi_axes[1] + tolerance);
  return a * a + b * b <= 1.0;
}

bool inside(const EllipsoidRegion& region, const Vector& point, double tolerance) {
  double square = 0.0;
  for (std::size_t i = 0; i < 3; ++i) {
    const double x = (point[i] - region.center[i]) / (region.semi_axes[i] + tolerance);
    square += x * x;
  }
  return square <= 1.0;
}

bool selects(const NodeSetRule& rule, const Vector& point, double tolerance) {
  for (std::size_t i = 0; i < 3; ++i) {
    if (!rule.within[i]) continue;
    if (point[i] < rule.within[i]->low - tolerance || point[i] > rule.within[i]->high + tolerance)
      return false;
  }
  return (!rule.cylinder || inside(*rule.cylinder, point, tolerance)) &&
         (!rule.ellipsoid || inside(*rule.ellipsoid, point, tolerance));
}

/// The set of that name; `member` is "a node" or "an element", `origins` the places that define such sets.
const std::vector<int>& named_set(const std::map<std::string, std::vector<int>>& sets,
                                  const std::string& file, const std::string& key, const std::string& name,
                                  const std::string& member, const std::string& origins) {
  const std::string place = fmt::format("{}: {} = '{}'", file, key, name);
  const auto found = sets.find(name);
  if (found == sets.end()) {
    const auto known = names_in(sets);
    // If several sets of a file share a name, readers name them SCOPE.NAME.
    std::string meant;
    for (const auto& [other, members] : sets) {
      if (other.ends_with('.' + name))
        meant += fmt::format("{}'{}' ({})", meant.empty() ? "" : " or ", other, members.size());
    }
    if (!meant.empty()) {
      throw InputError(fmt::format("{} means several sets of the file: write {}", place, meant));
    }
    throw InputError(
        fmt::format("{} is not {} set of this case{}", place, member,
                    known.empty() ? ", which has none: " + origins : "; " + suggestion(name, known)));
  }
  if (found->second.empty()) {
    throw InputError(fmt::format("{} has no {} in the mesh; a set needs at least one", place,
                                 member.substr(member.find(' ') + 1)));
  }
  return found->second;
}

}  // namespace

double rounding_of(const Mesh& mesh) {
  double largest = 0.0;
  for (const Vector& X : mesh.points) {
    for (const double x : X) largest = std::max(largest, std::abs(x));
  }
  return std::max(1e-9 * diagonal(mesh.points), std::min(5e-6 * largest, 1e-3 * shortest_edge(mesh)));
}

std::vector<int> select_nodes(const Mesh& mesh, const std::vector<bool>& on_boundary,
                              const NodeSetRule& rule) {
  const double tolerance = rounding_of(mesh);
  std::vector<int> nodes;
  for (std::size_t n = 0; n < mesh.points.size(); ++n) {
    if (rule.surface && !on_boundary[n]) continue;
    if (selects(rule, mesh.points[n], tolerance)) nodes.push_back(static_cast<int>(n));
  }
  return nodes;
}

std::string nearest_miss(const Mesh& mesh, const std::vector<bool>& on_boundary, const NodeSetRule& rule) {
  // The smallest tolerance with which the rule would select a node; all kinds of conditions are monotonic in
  // it.
  const auto first = [&](double tolerance) -> std::optional<std::size_t> {
    for (std::size_t n = 0; n < mesh.points.size(); ++n) {
      if ((!rule.surface || on_boundary[n]) && selects(rule, mesh.points[n], tolerance)) return n;
    }
    return std::nullopt;
  };
  double low = rounding_of(mesh), high = 2.0 * low;
  for (; !first(high); high *= 2.0)
    if (!std::isfinite(high)) return "no tolerance would take one";
  while (high - low > 1e-3 * high) (first(0.5 * (low + high)) ? high : low) = 0.5 * (low + high);
  const std::size_t node = *first(high);
  const Vector& X = mesh.points[node];
  return fmt::format(
      "the nearest, {} at ({:.9g}, {:.9g}, {:.9g}) m, is {:.3g} m outside: limits wider by that would take "
      "it; "
      "{:.2g} m are allowed for rounding",
      node, X[0], X[1], X[2], high, rounding_of(mesh));
}

std::vector<int> select_elements(const Mesh& mesh, const NodeSetRule& rule) {
  const double tolerance = rounding_of(mesh);
  std::vector<int> elements;
  for (std::size_t e = 0; e < mesh.cells.size(); ++e) {
    if (selects(rule, mean_at(mesh.cells[e], mesh.points), tolerance))
      elements.push_back(static_cast<int>(e));
  }
  return elements;
}

const std::vector<int>& named_node_set(const NodeSets& sets, const std::string& file, const std::string& key,
                                       const std::string& name) {
  return named_set(sets, file, key, name, "a node",
                   "[sets] gives rules for them, a mesh from a file brings its physical groups (Gmsh), NSETs "
                   "(Abaqus) or point arrays (VTK)");
}

const std::vector<int>& named_element_set(const ElementSets& sets, const std::string& file,
                                          const std::string& key, const std::string& name) {
  return named_set(sets, file, key, name, "an element",
                   "[element_sets] gives rules for them, a mesh from a file brings its physical volumes "
                   "(Gmsh), ELSETs (Abaqus) or cell arrays (VTK)");
}

}  // namespace sandglass
