#include "mesh/interpolation.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <optional>
#include <set>

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

std::vector<PointWithin> points_within(const NodalField& points, std::span<const Hexahedron> cells,
                                       std::span<const int> nodes, double share) {
  std::vector<bool> remains(points.size(), false);
  for (const int node : nodes) remains[at(node)] = true;
  std::vector<PointWithin> within;
  for (std::size_t e = 0; e < cells.size(); ++e) {
    for (const int node : cells[e]) {
      if (!remains[at(node)]) continue;
      remains[at(node)] = false;
      const Vector& X = points[at(node)];
      Vector inside = mean_at(cells[e], points);
      for (std::size_t i = 0; i < 3; ++i) inside[i] = X[i] + share * (inside[i] - X[i]);
      within.push_back({node, e, inside});
    }
  }
  return within;
}

std::vector<PointWithin> points_along_edges(const NodalField& points, std::span<const Hexahedron> cells,
                                            std::span<const int> nodes, double share) {
  std::vector<bool> is_one(points.size(), false);
  for (const int node : nodes) is_one[at(node)] = true;
  std::set<std::pair<int, int>> done;
  std::vector<PointWithin> along;
  for (std::size_t e = 0; e < cells.size(); ++e) {
    const Vector middle = mean_at(cells[e], points);
    for (const auto& [i, j] : hexahedron_edges) {
      const auto [a, b] = std::minmax(cells[e][i], cells[e][j]);
      if (!is_one[at(a)] || !is_one[at(b)] || !done.emplace(a, b).second) continue;
      constexpr int parts = 8;
      for (int k = 0; k < parts; ++k) {
        const double t = (k + 0.5) / parts;
        const Vector on_edge = sum(points[at(a)], t, difference(points[at(b)], points[at(a)]));
        along.push_back({t < 0.5 ? a : b, e, sum(on_edge, share, difference(middle, on_edge))});
      }
    }
  }
  return along;
}

std::vector<std::pair<PointWithin, std::size_t>> overlaps(const NodalField& points,
                                                          std::span<const Hexahedron> cells,
                                                          const std::vector<PointWithin>& some) {
  const ElementGrid grid(points, cells);
  std::vector<std::array<Vector, 2>> boxes;
  for (const Hexahedron& cell : cells) boxes.push_back(bounding_box(values_at(cell, points)));
  std::vector<std::pair<PointWithin, std::size_t>> found;
  for (const PointWithin& one : some) {
    for (const std::size_t e : grid.near(one.X)) {
      const auto& box = boxes[e];
      const auto beyond = [&](std::size_t i) { return one.X[i] < box[0][i] || one.X[i] > box[1][i]; };
      if (e == one.element || beyond(0) || beyond(1) || beyond(2)) continue;
      const auto xi = parent_point(gather(points, cells[e]), one.X);
      if (xi && parent_distance(*xi) < 1.0) found.emplace_back(one, e);
    }
  }
  return found;
}

}  // namespace sandglass
