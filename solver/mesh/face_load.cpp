#include "mesh/face_load.hpp"

#include <algorithm>
#include <cmath>

namespace sandglass {

std::array<Vector, 4> corners_of(const NodalField& points, const Quadrilateral& face) {
  std::array<Vector, 4> corners;
  for (std::size_t I = 0; I < 4; ++I) corners[I] = points[at(face[I])];
  return corners;
}

namespace {

/// The shape functions of the four nodes of a face and their derivatives, at a Gauss point.
struct FaceShape {
  std::array<double, 4> N, by_xi, by_eta;
};

std::array<FaceShape, 4> shapes_at_gauss_points() {
  constexpr std::array<std::array<double, 2>, 4> signs{{{-1, -1}, {1, -1}, {1, 1}, {-1, 1}}};
  const double a = 1.0 / std::sqrt(3.0);
  std::array<FaceShape, 4> shapes{};
  for (std::size_t q = 0; q < 4; ++q) {
    const double xi = a * signs[q][0], eta = a * signs[q][1];
    for (std::size_t I = 0; I < 4; ++I) {
      const auto [s, t] = signs[I];
      shapes[q].N[I] = (1.0 + s * xi) * (1.0 + t * eta) / 4.0;
      shapes[q].by_xi[I] = s * (1.0 + t * eta) / 4.0;
      shapes[q].by_eta[I] = t * (1.0 + s * xi) / 4.0;
    }
  }
  return shapes;
}

/// The sum of vectors at the nodes of a face, weighted.
Triple<double> sum(const std::array<double, 4>& weights, const std::array<Vector, 4>& vectors) {
  Triple<double> sum{};
  for (std::size_t I = 0; I < 4; ++I) sum += weights[I] * Triple<double>{vectors[I]};
  return sum;
}

}  // namespace

std::array<FacePoint, 4> gauss_points_of(const std::array<Vector, 4>& corners) {
  const std::array<FaceShape, 4> shapes = shapes_at_gauss_points();
  std::array<FacePoint, 4> result;
  for (std::size_t q = 0; q < 4; ++q) {
    const auto& [N, by_xi, by_eta] = shapes[q];
    const Triple<double> normal = cross(sum(by_xi, corners), sum(by_eta, corners));
    result[q] = {N, sum(N, corners), std::sqrt(double_dot(normal, normal)), normal};
  }
  return result;
}

std::array<Vector, 4> derivatives_of_pressure_power(const std::array<Vector, 4>& x,
                                                    const std::array<Vector, 4>& w) {
  std::array<Vector, 4> derivatives{};
  for (const auto& [N, by_xi, by_eta] : shapes_at_gauss_points()) {
    const Triple<double> v = sum(N, w);  // the power is -v . (dx/dxi x dx/deta)
    const Triple<double> by_x_xi = cross(sum(by_eta, x), v), by_x_eta = cross(v, sum(by_xi, x));
    for (std::size_t I = 0; I < 4; ++I) {
      for (std::size_t i = 0; i < 3; ++i)
        derivatives[I][i] -= by_xi[I] * by_x_xi.entries[i] + by_eta[I] * by_x_eta.entries[i];
    }
  }
  return derivatives;
}

std::array<Vector, 4> pressure_forces(const std::array<Vector, 4>& x) {
  std::array<Vector, 4> forces{};
  for (const auto& point : gauss_points_of(x)) {
    for (std::size_t I = 0; I < 4; ++I) {
      for (std::size_t i = 0; i < 3; ++i) forces[I][i] -= point.N[I] * point.normal.entries[i];
    }
  }
  return forces;
}

std::vector<Quadrilateral> faces_within(std::vector<Quadrilateral> faces, const std::vector<int>& nodes) {
  const auto inside = [&](int node) { return std::binary_search(nodes.begin(), nodes.end(), node); };
  std::erase_if(faces,
                [&](const Quadrilateral& face) { return !std::all_of(face.begin(), face.end(), inside); });
  return faces;
}

std::vector<NodalLoad> consistent_loads(const NodalField& points, const std::vector<Quadrilateral>& faces,
                                        const Vector& total, const Vector& moment) {
  double area = 0.0;
  Triple<double> c{};
  for (const auto& face : faces) {
    for (const auto& point : gauss_points_of(corners_of(points, face))) {
      area += point.area;
      c += point.area * point.X;
    }
  }
  c = (1.0 / area) * c;
  Tensor<double> inertia{};  // of the area: moment = inertia b
  for (const auto& face : faces) {
    for (const auto& point : gauss_points_of(corners_of(points, face))) {
      const Triple<double> r = point.X - c;
      inertia += point.area * (double_dot(r, r) * identity<double>() - r * transpose(r));
    }
  }
  const Triple<double> a = (1.0 / area) * Triple<double>{total};
  const Triple<double> b = inverse(inertia) * Triple<double>{moment};
  std::map<int, Vector> forces;
  for (const auto& face : faces) {
    for (const auto& point : gauss_points_of(corners_of(points, face))) {
      const Triple<double> t = a + cross(b, point.X - c);
      for (std::size_t I = 0; I < 4; ++I) {
        Vector& force = forces[face[I]];
        for (std::size_t i = 0; i < 3; ++i) force[i] += point.N[I] * point.area * t.entries[i];
      }
    }
  }
  std::vector<NodalLoad> loads;
  loads.reserve(forces.size());
  for (const auto& [node, force] : forces) loads.push_back({.node = node, .force = force});
  return loads;
}

}  // namespace sandglass
