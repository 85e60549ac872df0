#include "mesh/oddities.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <unordered_map>

#include "mesh/edges.hpp"

namespace sandglass {

namespace {

/// A description of the nodes on both sides of an interval's end that are so close together that they seem to
/// be one plane; empty if there are none. `coordinates` are sorted.
std::string cut_at(const std::vector<double>& coordinates, double end, bool selected_below, double most) {
  const auto upper = std::ranges::upper_bound(coordinates, end);
  if (upper == coordinates.begin() || upper == coordinates.end()) return "";
  auto low = upper, high = upper;
  // From the gap that contains the end, the neighbours that are closer to each other than `most`.
  while (low != coordinates.begin() && *std::prev(low) > *upper - most) --low;
  while (high != coordinates.end() && *high < *low + most) ++high;
  const double width = *std::prev(high) - *low;
  if (low == upper || high - low < 4) return "";
  const bool alone = (low == coordinates.begin() || *low - *std::prev(low) > 5.0 * width) &&
                     (high == coordinates.end() || *high - *std::prev(high) > 5.0 * width);
  if (!alone) return "";
  const auto below = upper - low, above = high - upper;
  return fmt::format("{} of {} nodes between {:.9g} and {:.9g} m", selected_below ? below : above, high - low,
                     *low, *std::prev(high));
}

}  // namespace

SetShape shape_of(const Mesh& mesh, const std::vector<Quadrilateral>& boundary,
                  const std::vector<int>& nodes) {
  SetShape shape;
  std::vector<bool> inside(mesh.points.size(), false);
  for (const int node : nodes) inside[at(node)] = true;
  const auto in = [&](int node) { return inside[at(node)]; };
  for (const Hexahedron& cell : mesh.cells) {
    shape.elements += std::ranges::all_of(cell, in) ? 1U : 0U;
    for (const auto& [a, b] : hexahedron_edges) shape.edges += in(cell[a]) && in(cell[b]) ? 1U : 0U;
  }
  shape.faces = static_cast<std::size_t>(
      std::ranges::count_if(boundary, [&](const auto& face) { return std::ranges::all_of(face, in); }));
  return shape;
}

namespace {

/// Whether two nodes on both sides of an end of an interval along axis i are that close: of few rules, which
/// saves the selection of the nodes.
bool may_cut(const Mesh& mesh, std::size_t i, double end, double most) {
  double below = -INFINITY, above = INFINITY;
  for (const Vector& X : mesh.points) {
    if (X[i] <= end) {
      below = std::max(below, X[i]);
    } else {
      above = std::min(above, X[i]);
    }
  }
  return above - below < most;
}

/// As `cut_planes`, for one rule.
std::string cut_plane(const Mesh& mesh, const std::vector<bool>& on_boundary, const NodeSetRule& rule,
                      double rounding, double most) {
  for (std::size_t i = 0; i < 3; ++i) {
    if (!rule.within[i]) continue;
    for (const bool upper : {false, true}) {
      NodeSetRule others = rule;
      Interval& interval = *others.within[i];
      const double end =
          upper ? interval.high + rounding : std::nextafter(interval.low - rounding, -INFINITY);
      if (!std::isfinite(end) || !may_cut(mesh, i, end, most)) continue;
      // Without this end of the interval.
      (upper ? interval.high : interval.low) = upper ? INFINITY : -INFINITY;
      std::vector<double> coordinates;
      for (const int node : select_nodes(mesh, on_boundary, others))
        coordinates.push_back(mesh.points[at(node)][i]);
      std::ranges::sort(coordinates);
      const std::string cut = cut_at(coordinates, end, upper, most);
      if (!cut.empty()) return fmt::format("selects {} in {}", cut, "xyz"[i]);
    }
  }
  return "";
}

}  // namespace

std::vector<std::string> cut_planes(const Mesh& mesh, const std::vector<bool>& on_boundary,
                                    const std::vector<NodeSetRule>& rules) {
  const double rounding = rounding_of(mesh), most = 0.02 * shortest_edge(mesh);
  std::vector<std::string> cuts;
  for (const NodeSetRule& rule : rules) {
    const std::string cut = cut_plane(mesh, on_boundary, rule, rounding, most);
    if (!cut.empty()) cuts.push_back(fmt::format("sets.{} {}", rule.name, cut));
  }
  return cuts;
}

Seam seam_of(const Mesh& mesh, const Ties& ties, const std::vector<Quadrilateral>& boundary) {
  const double rounding = rounding_of(mesh);
  std::vector<bool> looked_at = nodes_of(boundary, mesh.points.size());
  for (const Tie& tie : ties) looked_at[at(tie.node)] = false;
  // Nodes by the cells of a grid; nodes at one place are in the same cell or in adjacent ones.
  const auto number = [&](double x, int shift) {
    return static_cast<std::int64_t>(std::floor(x / (4.0 * rounding))) + shift;
  };
  const auto key = [](std::int64_t x, std::int64_t y, std::int64_t z) {
    return (x * 73856093) ^ (y * 19349663) ^ (z * 83492791);
  };
  std::unordered_map<std::int64_t, std::vector<int>> grid;
  Seam seam;
  for (std::size_t n = 0; n < mesh.points.size(); ++n) {
    if (!looked_at[n]) continue;
    const Vector& X = mesh.points[n];
    for (int c = 0; c < 27; ++c) {
      const auto found =
          grid.find(key(number(X[0], c % 3 - 1), number(X[1], c / 3 % 3 - 1), number(X[2], c / 9 - 1)));
      if (found == grid.end()) continue;
      for (const int other : found->second) {
        const double apart = distance(X, mesh.points[at(other)]);
        if (apart > rounding) continue;
        if (seam.pairs++ == 0) {
          seam.first = other;
          seam.second = static_cast<int>(n);
        }
        seam.distance = std::max(seam.distance, apart);
      }
    }
    grid[key(number(X[0], 0), number(X[1], 0), number(X[2], 0))].push_back(static_cast<int>(n));
  }
  return seam;
}

std::string described(const Seam& seam, const Mesh& mesh) {
  if (seam.pairs == 0) return "";
  const Vector& X = mesh.points[at(seam.first)];
  return fmt::format(
      "{} pair{} of boundary nodes lie at one place{}, but are not joined, such as {} and {} at ({:.6g}, "
      "{:.6g}, {:.6g}) m; unless this is a gap, merge them in the program that made the mesh, or use [[tie]]",
      seam.pairs, seam.pairs == 1 ? "" : "s",
      seam.distance > 0.0 ? fmt::format(", up to {:.2g} m apart", seam.distance) : "", seam.first,
      seam.second, X[0], X[1], X[2]);
}

}  // namespace sandglass
