#include "mesh/interpolation.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <optional>
#include <set>
#include <utility>

#include "base/error.hpp"
#include "mesh/edges.hpp"
#include "mesh/hexahedron.hpp"
#include "mesh/vectors.hpp"

namespace sandglass {

double parent_distance(const Vector& xi) {
  return std::max({std::abs(xi[0]), std::abs(xi[1]), std::abs(xi[2])});
}

namespace {

Vector trilinear(const NodalVectors<double>& nodal, const Vector& xi) {
  const auto N = shape_functions(xi);
  Vector value{};
  for (int I = 0; I < nodal.rows; ++I) {
    for (int i = 0; i < 3; ++i) {
      value[at(i)] += N[at(I)] * nodal(I, i);
    }
  }
  return value;
}

/// The parent point of X in an element, by Newton's method; none if it does not converge, as for points far
/// outside. Positions are relative to X, so a body far from the origin does not suffer from roundoff.
std::optional<Vector> parent_point(NodalVectors<double> nodes, const Vector& X) {
  constexpr int most_steps = 25;
  constexpr double converged = 1e-13, far_away = 10.0;
  for (int I = 0; I < nodes.rows; ++I) {
    for (int i = 0; i < 3; ++i) nodes(I, i) -= X[at(i)];
  }
  Vector xi{};
  for (int step = 0; step < most_steps; ++step) {
    const Vector there = trilinear(nodes, xi);
    const Tensor<double> inverse_jacobian = inverse(parent_jacobian(nodes, xi));
    double moved = 0.0;
    for (int i = 0; i < 3; ++i) {
      double d = 0.0;
      for (int j = 0; j < 3; ++j) d -= inverse_jacobian(i, j) * there[at(j)];
      xi[at(i)] += d;
      moved = std::max(moved, std::abs(d));
    }
    if (!(parent_distance(xi) < far_away)) return std::nullopt;
    if (moved < converged) return xi;
  }
  return std::nullopt;
}

/// Elements sorted into the boxes of a grid over the mesh, by the boxes that their bounding boxes touch.
class ElementGrid {
 public:
  ElementGrid(const NodalField& points, std::span<const Hexahedron> cells)
      : points_(points), cells_(cells), low_(bounding_box(points)[0]) {
    const Vector high = bounding_box(points)[1];
    const double volume = (high[0] - low_[0]) * (high[1] - low_[1]) * (high[2] - low_[2]);
    spacing_ = std::cbrt(volume / static_cast<double>(cells.size()));
    for (std::size_t i = 0; i < 3; ++i) {
      counts_[i] = std::max(1, static_cast<int>(std::ceil((high[i] - low_[i]) / spacing_)));
    }
    bins_.resize(at(counts_[0]) * at(counts_[1]) * at(counts_[2]));
    for (std::size_t e = 0; e < cells.size(); ++e) enter(e);
  }

  /// Elements that may contain a point, or are close to it.
  const std::vector<std::size_t>& near(const Vector& X) const {
    return bins_[number({place(X, 0), place(X, 1), place(X, 2)})];
  }

 private:
  void enter(std::size_t e) {
    auto [low, high] = bounding_box(values_at(cells_[e], points_));
    for (std::size_t i = 0; i < 3; ++i) {  // points outside the mesh lie within half an element of it
      const double reach = 0.5 * (high[i] - low[i]);
      low[i] -= reach;
      high[i] += reach;
    }
    for (int x = place(low, 0); x <= place(high, 0); ++x) {
      for (int y = place(low, 1); y <= place(high, 1); ++y) {
        for (int z = place(low, 2); z <= place(high, 2); ++z) bins_[number({x, y, z})].push_back(e);
      }
    }
  }

  int place(const Vector& X, std::size_t i) const {
    return static_cast<int>(std::clamp((X[i] - low_[i]) / spacing_, 0.0, counts_[i] - 1.0));
  }

  std::size_t number(const std::array<int, 3>& p) const {
    std::size_t n = 0;
    for (std::size_t i = 0; i < 3; ++i) {
      n = n * at(counts_[i]) + at(p[i]);
    }
    return n;
  }

  const NodalField& points_;
  std::span<const Hexahedron> cells_;
  Vector low_;
  double spacing_ = 0.0;
  std::array<int, 3> counts_{};
  std::vector<std::vector<std::size_t>> bins_;
};

/// The place a share of the way from a point (m) to another.
Vector towards(const Vector& other, double share, const Vector& X) {
  return sum(X, share, difference(other, X));
}

/// The face at the end of an edge of an element, which has one of its nodes and not the other; sorted.
Quadrilateral end_face(const Hexahedron& cell, int node, int other) {
  const auto place = [&](int of) { return static_cast<int>(std::ranges::find(cell, of) - cell.begin()); };
  int axis = 0;
  while (corner_signs(place(node), axis) == corner_signs(place(other), axis)) ++axis;
  Quadrilateral face{};
  std::size_t count = 0;
  for (int I = 0; I < corner_signs.rows; ++I) {
    if (corner_signs(I, axis) == corner_signs(place(node), axis)) face[count++] = cell[at(I)];
  }
  std::ranges::sort(face);
  return face;
}

/// The first and the last place (0 to 1) of a line from a point along a way (m) within a box; none outside.
std::optional<std::pair<double, double>> part_within(const std::array<Vector, 2>& box, const Vector& from,
                                                     const Vector& way) {
  double first = 0.0, last = 1.0;
  for (std::size_t i = 0; i < 3; ++i) {
    const double low = box[0][i] - from[i], high = box[1][i] - from[i];
    if (way[i] == 0.0) {
      if (low > 0.0 || high < 0.0) return std::nullopt;
      continue;
    }
    const auto [in, out] = std::minmax({low / way[i], high / way[i]});
    first = std::max(first, in);
    last = std::min(last, out);
  }
  if (first > last) return std::nullopt;
  return std::pair(first, last);
}

/// Whether a part of a line from a point along a way (m) is within an element. The distance in parent
/// coordinates is convex along the line, in a parallelepiped exactly: between three places, the middle one
/// the nearest, it is below the middle by no more than the others are above it.
bool enters(const NodalVectors<double>& nodal, const Vector& from, const Vector& way,
            const std::pair<double, double>& part) {
  struct Place {
    double t, distance;
  };
  const auto look = [&](double t) {
    const auto xi = parent_point(nodal, sum(from, t, way));
    return Place{t, xi ? parent_distance(*xi) : INFINITY};
  };
  Place first = look(part.first), last = look(part.second), middle = look(std::midpoint(first.t, last.t));
  constexpr int halvings = 30;
  for (int k = 0; k < halvings; ++k) {
    if (std::min({first.distance, middle.distance, last.distance}) < 1.0) return true;
    if (2.0 * middle.distance - std::max(first.distance, last.distance) >= 1.0) return false;
    const Place before = look(std::midpoint(first.t, middle.t)),
                after = look(std::midpoint(middle.t, last.t));
    if (before.distance < middle.distance) {
      last = std::exchange(middle, before);
    } else if (after.distance < middle.distance) {
      first = std::exchange(middle, after);
    } else {
      first = before;
      last = after;
    }
  }
  return false;
}

}  // namespace

std::vector<ElementPoint> element_points(const Mesh& mesh, const NodalField& points) {
  const ElementGrid grid(mesh.points, mesh.cells);
  std::vector<std::size_t> everywhere(mesh.cells.size());
  std::iota(everywhere.begin(), everywhere.end(), 0U);
  std::vector<ElementPoint> places;
  places.reserve(points.size());
  for (const Vector& X : points) {
    constexpr double inside = 1.0 + 1e-10;
    double least = std::numeric_limits<double>::infinity();
    ElementPoint place{};
    const auto look_in = [&](const std::vector<std::size_t>& elements) {
      for (const std::size_t e : elements) {
        const auto xi = parent_point(gather(mesh.points, mesh.cells[e]), X);
        if (!xi || !(parent_distance(*xi) < least)) continue;
        least = parent_distance(*xi);
        place = {e, *xi};
        if (least <= inside) return;
      }
    };
    look_in(grid.near(X));
    if (!std::isfinite(least)) look_in(everywhere);
    if (!std::isfinite(least)) {
      throw InputError(
          fmt::format("interpolation: the point ({}, {}, {}) m is far outside the mesh", X[0], X[1], X[2]));
    }
    places.push_back(place);
  }
  return places;
}

NodalField interpolate(const Mesh& mesh, const NodalField& field, const NodalField& points) {
  NodalField values;
  values.reserve(points.size());
  for (const auto& [element, parent] : element_points(mesh, points))
    values.push_back(trilinear(gather(field, mesh.cells[element]), parent));
  return values;
}

std::vector<LineWithin> points_within(const NodalField& points, std::span<const Hexahedron> cells,
                                      std::span<const int> nodes, double share) {
  std::vector<bool> remains(points.size(), false);
  for (const int node : nodes) remains[at(node)] = true;
  std::vector<LineWithin> within;
  for (const Hexahedron& cell : cells) {
    const Vector middle = mean_at(cell, points);
    for (const int node : cell) {
      if (!remains[at(node)]) continue;
      remains[at(node)] = false;
      const Vector X = towards(middle, share, points[at(node)]);
      within.push_back({{node, node}, X, X});
    }
  }
  return within;
}

std::vector<LineWithin> edges_within(const NodalField& points, std::span<const Hexahedron> cells,
                                     std::span<const int> nodes, double share) {
  std::vector<bool> is_one(points.size(), false);
  for (const int node : nodes) is_one[at(node)] = true;
  std::set<Quadrilateral> boundary;
  for (Quadrilateral face : boundary_faces(cells)) {
    std::ranges::sort(face);
    boundary.insert(face);
  }
  std::set<std::pair<int, int>> done;
  std::vector<LineWithin> within;
  for (const Hexahedron& cell : cells) {
    const Vector middle = mean_at(cell, points);
    for (const auto& [i, j] : hexahedron_edges) {
      const auto [a, b] = std::minmax(cell[i], cell[j]);
      if (!is_one[at(a)] || !is_one[at(b)] || !done.emplace(a, b).second) continue;
      const Vector of_edge = towards(points[at(b)], 0.5, points[at(a)]);
      const auto line_end = [&](int node, int other) {
        const Vector& X = points[at(node)];
        const Vector& from = boundary.contains(end_face(cell, node, other)) ? X : of_edge;
        return sum(X, share, difference(middle, from));
      };
      within.push_back({{a, b}, line_end(a, b), line_end(b, a)});
    }
  }
  return within;
}

std::vector<std::pair<LineWithin, std::size_t>> overlaps(const NodalField& points,
                                                         std::span<const Hexahedron> cells,
                                                         const std::vector<LineWithin>& lines) {
  const ElementGrid grid(points, cells);
  std::vector<std::array<Vector, 2>> boxes;
  for (const Hexahedron& cell : cells) boxes.push_back(bounding_box(values_at(cell, points)));
  std::vector<std::pair<LineWithin, std::size_t>> found;
  std::vector<std::size_t> near;
  constexpr int looks = 16;  // along an edge: the grid has elements at half their size
  for (const LineWithin& line : lines) {
    const Vector way = difference(line.to, line.from);
    near.clear();
    for (int k = 0; k < looks; ++k) {
      const auto& here = grid.near(sum(line.from, (k + 0.5) / looks, way));
      near.insert(near.end(), here.begin(), here.end());
    }
    std::ranges::sort(near);
    near.erase(std::unique(near.begin(), near.end()), near.end());
    for (const std::size_t e : near) {
      if (std::ranges::find_first_of(cells[e], line.nodes) != cells[e].end()) continue;
      const auto part = part_within(boxes[e], line.from, way);
      if (part && enters(gather(points, cells[e]), line.from, way, *part)) found.emplace_back(line, e);
    }
  }
  return found;
}

std::vector<std::pair<LineWithin, std::size_t>> overlaps(const NodalField& points,
                                                         std::span<const Hexahedron> cells,
                                                         std::span<const int> nodes, double from_points,
                                                         double from_edges) {
  auto lines = points_within(points, cells, nodes, from_points);
  const auto edges = edges_within(points, cells, nodes, from_edges);
  lines.insert(lines.end(), edges.begin(), edges.end());
  return overlaps(points, cells, lines);
}

}  // namespace sandglass
