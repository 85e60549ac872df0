#include "forces/moving_surface.hpp"

#include <algorithm>
#include <map>

#include "forces/obstacle_shape.hpp"
#include "forces/triangle_foot.hpp"

namespace sandglass {

namespace {

std::vector<int> sorted_nodes_of(const std::vector<Quadrilateral>& faces) {
  std::vector<int> nodes = nodes_of(faces);
  std::ranges::sort(nodes);
  nodes.erase(std::unique(nodes.begin(), nodes.end()), nodes.end());
  return nodes;
}

/// The faces by places in `nodes`.
std::vector<Quadrilateral> renumbered(std::vector<Quadrilateral> faces, const std::vector<int>& nodes) {
  for (Quadrilateral& face : faces) {
    for (int& node : face) node = static_cast<int>(std::ranges::lower_bound(nodes, node) - nodes.begin());
  }
  return faces;
}

NodalField centres_of(const std::vector<Quadrilateral>& faces, const NodalField& points) {
  NodalField centres;
  for (const Quadrilateral& face : faces) centres.push_back(mean_at(face, points));
  return centres;
}

/// Whether no other face has an edge, from each corner to the next.
std::vector<std::array<bool, 4>> rim_of(const std::vector<Quadrilateral>& faces) {
  std::map<std::pair<int, int>, int> count;
  const auto edge = [](const Quadrilateral& face, std::size_t k) {
    return std::minmax(face[k], face[(k + 1) % 4]);
  };
  for (const Quadrilateral& face : faces) {
    for (std::size_t k = 0; k < 4; ++k) ++count[edge(face, k)];
  }
  std::vector<std::array<bool, 4>> on_rim(faces.size());
  for (std::size_t f = 0; f < faces.size(); ++f) {
    for (std::size_t k = 0; k < 4; ++k) on_rim[f][k] = count[edge(faces[f], k)] == 1;
  }
  return on_rim;
}

/// Twice the area of a face times its normal, m^2.
Vector normal_of(const std::array<Vector, 4>& x) {
  return cross(difference(x[2], x[0]), difference(x[3], x[1]));
}

/// Whether the angle between the normals of a face and of a point has at most this cosine.
bool opposes(const Vector& of_face, const Vector& of_point, double cosine) {
  return dot(of_face, of_point) < cosine * length(of_face) * length(of_point);
}

/// The k-th of the four triangles of a face.
std::array<Vector, 3> triangle_of(const std::array<Vector, 4>& x, std::size_t k) {
  const Vector centre = sum(sum(sum(sum({}, 0.25, x[0]), 0.25, x[1]), 0.25, x[2]), 0.25, x[3]);
  return {x[k], x[(k + 1) % 4], centre};
}

/// Unit vectors along the first edge of a triangle, normal to it, and across.
std::array<Vector, 3> frame_of(const std::array<Vector, 3>& X) {
  const Vector edge = difference(X[1], X[0]), up = cross(edge, difference(X[2], X[0]));
  const Vector along = direction_of(edge, length(edge)), normal = direction_of(up, length(up));
  return {along, normal, cross(normal, along)};
}

/// The weights of the corners of a face, from those of its k-th triangle.
Row<double> of_corners(const Vector& weights, std::size_t k) {
  const double quarter = 0.25 * weights[2];
  Row<double> all{{quarter, quarter, quarter, quarter}};
  all[k] += weights[0];
  all[(k + 1) % 4] += weights[1];
  return all;
}

}  // namespace

MovingSurface::MovingSurface(const NodalField& points, const std::vector<Quadrilateral>& faces)
    : nodes_(sorted_nodes_of(faces)),
      undeformed_(values_at(nodes_, points)),
      faces_(renumbered(faces, nodes_)),
      on_rim_(rim_of(faces_)),
      tree_(centres_of(faces_, undeformed_), 1) {
  std::map<std::vector<int>, std::size_t> known;  // points by their nodes
  constexpr std::array<std::array<double, 2>, 4> corners{{{-1, -1}, {1, -1}, {1, 1}, {-1, 1}}};
  for (const Quadrilateral& face : faces_) {
    const auto X = corners_of(undeformed_, face);
    areas_.push_back(0.0);
    for (int place = 0; place < 9; ++place) {
      const int column = place % 3 - 1, row = place / 3 - 1;
      const double xi = column, eta = row;
      Row<double> weights;
      Vector along_xi{}, along_eta{};
      std::vector<int> nodes;
      for (std::size_t I = 0; I < 4; ++I) {
        const double a = 1.0 + xi * corners[I][0], b = 1.0 + eta * corners[I][1];
        weights[I] = 0.25 * a * b;
        along_xi = sum(along_xi, 0.25 * corners[I][0] * b, X[I]);
        along_eta = sum(along_eta, 0.25 * corners[I][1] * a, X[I]);
        if (weights[I] > 0.0) nodes.push_back(face[I]);
      }
      std::ranges::sort(nodes);
      const double simpson = (xi == 0.0 ? 4.0 : 1.0) * (eta == 0.0 ? 4.0 : 1.0) / 9.0;
      const auto [one, is_new] = known.try_emplace(nodes, points_.size());
      if (is_new) points_.push_back({weights, 0.0, face});
      const double area = simpson * length(cross(along_xi, along_eta));
      points_[one->second].area += area;
      areas_.back() += area;
    }
  }
}

void MovingSurface::fit(Row<double>* rows) const {
  Row<double>* normals = rows + nodes_.size();
  std::fill(normals, normals + nodes_.size(), Row<double>{});
  for (std::size_t f = 0; f < faces_.size(); ++f) {
    const Vector twice_area = normal_of(corners_now(static_cast<int>(f), rows));
    const Vector normal = direction_of(twice_area, length(twice_area));
    for (const int node : faces_[f]) {
      for (std::size_t i = 0; i < 3; ++i) normals[node][i] += normal[i];
    }
  }
  tree_.fit(rows + 2 * nodes_.size(), [&](int face, const auto& grow) {
    for (const int node : corners(face)) grow(rows[node]);
  });
}

std::array<Vector, 4> MovingSurface::corners_now(int face, const Row<double>* rows) const {
  std::array<Vector, 4> x;
  for (std::size_t I = 0; I < 4; ++I) {
    const Row<double>& row = rows[corners(face)[I]];
    x[I] = {row[0], row[1], row[2]};
  }
  return x;
}

SurfaceFoot MovingSurface::closest(const Vector& x, const Vector& normal, double cosine, double reach,
                                   const std::vector<int>& except, const Row<double>* rows) const {
  SurfaceFoot closest{.square = reach * reach};
  tree_.search(x, rows + 2 * nodes_.size(), closest.square, [&](int face) {
    const auto corners = corners_now(face, rows);
    if (!opposes(normal_of(corners), normal, cosine) || std::ranges::binary_search(except, face)) return;
    const auto compare = [&](const std::array<Vector, 3>& triangle, const Vector& weights, std::size_t k) {
      const Vector there = point_of(triangle, weights), from = difference(x, there);
      const double square = dot(from, from);
      if (square < closest.square) closest = {square, face, k, of_corners(weights, k), there};
    };
    bool within = false;
    for (std::size_t k = 0; k < 4; ++k) {
      const auto triangle = triangle_of(corners, k);
      const Vector weights = plane_weights(triangle, x);
      if (!is_within(weights)) continue;
      compare(triangle, weights, k);
      within = true;
    }
    for (std::size_t k = 0; k < 4 && !within; ++k) {  // each edge of the face, and from it to the middle
      const auto triangle = triangle_of(corners, k);
      const double along = share_of_edge(triangle[0], triangle[1], x),
                   inwards = share_of_edge(triangle[0], triangle[2], x);
      compare(triangle, {1.0 - along, along, 0.0}, k);
      compare(triangle, {1.0 - inwards, 0.0, inwards}, k);
    }
  });
  if (closest.face >= 0) set_behind(x, closest, rows);
  return closest;
}

void MovingSurface::set_behind(const Vector& x, SurfaceFoot& foot, const Row<double>* rows) const {
  const auto x_of_face = corners_now(foot.face, rows);
  const auto triangle = triangle_of(x_of_face, foot.triangle);
  const std::size_t k = foot.triangle, next = (k + 1) % 4;
  const auto& rim = on_rim_[at(foot.face)];
  if ((foot.weights[k] + foot.weights[next] == 1.0 && rim[k]) ||
      (foot.weights[k] == 1.0 && rim[(k + 3) % 4]) || (foot.weights[next] == 1.0 && rim[next])) {
    const Vector weights = plane_weights(triangle, x);
    foot.weights = of_corners(weights, k);
    foot.x = point_of(triangle, weights);
    const Vector from = difference(x, foot.x);
    foot.square = dot(from, from);
    foot.behind = dot(from, normal_of(x_of_face)) < 0.0;
    return;
  }
  constexpr double least_cosine = 0.5;
  const Vector n = normal(corners(foot.face), foot.weights, rows);
  foot.behind = dot(difference(x, foot.x), n) < -least_cosine * std::sqrt(foot.square * dot(n, n));
}

Row<double> MovingSurface::weights_at(const SurfaceFoot& foot, const Vector& x,
                                      const Row<double>* rows) const {
  const auto triangle = triangle_of(corners_now(foot.face, rows), foot.triangle);
  return of_corners(plane_weights(triangle, x), foot.triangle);
}

MovingSurface::Plane MovingSurface::plane_at(int face, std::size_t triangle, const Vector& x,
                                             const Row<double>* rows) const {
  const auto X = triangle_of(corners_now(face, rows), triangle);
  const Vector up = cross(difference(X[1], X[0]), difference(X[2], X[0])), weights = plane_weights(X, x),
               normal = direction_of(up, length(up));
  return {normal, dot(normal, difference(x, X[0])), of_corners(weights, triangle),
          *std::ranges::min_element(weights)};
}

std::pair<Vector, Vector> MovingSurface::directions(const SurfaceFoot& foot, const Vector& x,
                                                    const std::array<Vector, 4>& now,
                                                    const std::array<Vector, 4>& then) {
  const auto of_now = frame_of(triangle_of(now, foot.triangle)),
             of_then = frame_of(triangle_of(then, foot.triangle));
  constexpr double rounding = 1e-6;  // of the edge: closer points have no direction of their own
  const double depth = foot.distance();
  if (!(depth > rounding * distance(now[foot.triangle], now[(foot.triangle + 1) % 4])))
    return {of_now[1], of_then[1]};
  const Vector direction = direction_of(difference(foot.x, x), depth);
  Vector turned{};
  for (std::size_t i = 0; i < 3; ++i) turned = sum(turned, dot(direction, of_now[i]), of_then[i]);
  return {direction, turned};
}

Row<double> MovingSurface::weights_along(const std::array<Vector, 4>& corners, std::size_t triangle,
                                         const Vector& x, const Vector& direction) {
  const auto X = triangle_of(corners, triangle);
  const Vector normal = cross(difference(X[1], X[0]), difference(X[2], X[0]));
  const double way = dot(difference(X[0], x), normal) / dot(direction, normal);
  return of_corners(plane_weights(X, sum(x, way, direction)), triangle);
}

std::vector<std::vector<int>> faces_around(const MovingSurface& surface,
                                           const std::vector<Quadrilateral>& faces,
                                           std::span<const Hexahedron> cells) {
  std::map<int, std::vector<int>> faces_at, cells_at;
  for (std::size_t f = 0; f < faces.size(); ++f) {
    for (const int node : faces[f]) faces_at[node].push_back(static_cast<int>(f));
  }
  for (const int node : surface.nodes()) cells_at[node] = {};
  for (std::size_t e = 0; e < cells.size(); ++e) {
    for (const int node : cells[e]) {
      if (const auto known = cells_at.find(node); known != cells_at.end())
        known->second.push_back(static_cast<int>(e));
    }
  }
  std::vector<std::vector<int>> around;
  for (const SurfacePoint& point : surface.points()) {
    std::vector<int>& found = around.emplace_back();
    for (std::size_t I = 0; I < 4; ++I) {
      if (point.weights[I] == 0.0) continue;
      for (const int cell : cells_at[surface.nodes()[at(point.nodes[I])]]) {
        for (const int node : cells[at(cell)]) {
          if (const auto known = faces_at.find(node); known != faces_at.end())
            found.insert(found.end(), known->second.begin(), known->second.end());
        }
      }
    }
    std::ranges::sort(found);
    found.erase(std::unique(found.begin(), found.end()), found.end());
  }
  return around;
}

}  // namespace sandglass
