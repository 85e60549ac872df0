#include "mesh/face_load.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <map>

namespace sandglass {

std::array<Vector, 4> corners_of(const NodalField& points, const Quadrilateral& face) {
  std::array<Vector, 4> corners;
  for (std::size_t I = 0; I < 4; ++I) corners[I] = points[at(face[I])];
  return corners;
}

namespace {

std::array<Triple<double>, 4> triples(const std::array<Vector, 4>& corners) {
  return {{{corners[0]}, {corners[1]}, {corners[2]}, {corners[3]}}};
}

}  // namespace

std::array<FacePoint, 4> gauss_points_of(const std::array<Vector, 4>& corners) {
  return gauss_points_of(triples(corners));
}

std::array<Vector, 4> pressure_forces(const std::array<Vector, 4>& x) {
  const auto forces = pressure_forces(triples(x));
  return {forces[0].entries, forces[1].entries, forces[2].entries, forces[3].entries};
}

Triple<double> interpolated(const std::array<double, 4>& N, const std::array<Vector, 4>& nodal) {
  Triple<double> mean{};
  for (std::size_t I = 0; I < 4; ++I) mean += N[I] * Triple<double>{nodal[I]};
  return mean;
}

void add_at_corners(double factor, const std::array<Vector, 4>& own, const Quadrilateral& face,
                    NodalField& field) {
  for (std::size_t I = 0; I < 4; ++I) {
    for (std::size_t i = 0; i < 3; ++i) field[at(face[I])][i] += factor * own[I][i];
  }
}

std::vector<Quadrilateral> faces_within(std::vector<Quadrilateral> faces, const std::vector<int>& nodes) {
  const auto inside = [&](int node) { return std::binary_search(nodes.begin(), nodes.end(), node); };
  std::erase_if(faces,
                [&](const Quadrilateral& face) { return !std::all_of(face.begin(), face.end(), inside); });
  return faces;
}

namespace {

/// Integrals over faces that determine the power of a traction: of 1, X, X X^T, the velocity w and X x w.
template <class T>
struct FaceSums {
  T area;
  Triple<T> X;
  Tensor<T> XX;
  Triple<T> w, Xw;
};

/// Those of a face whose nodes have the velocities v, with positions from an origin.
template <class T>
FaceSums<T> sums_of(const std::array<FacePointOf<T>, 4>& points, const std::array<Vector, 4>& v,
                    const Triple<T>& origin) {
  FaceSums<T> sums{};
  for (const auto& point : points) {
    const Triple<T> X = point.X - origin, w = from_double<T>(interpolated(point.N, v));
    sums.area = sums.area + point.area;
    sums.X += point.area * X;
    sums.XX += point.area * (X * transpose(X));
    sums.w += point.area * w;
    sums.Xw += point.area * cross(X, w);
  }
  return sums;
}

/// A traction a + b x (X - c); see consistent_loads.
template <class T>
struct Traction {
  Triple<T> a, b, c;

  Traction(const FaceSums<T>& sums, const Vector& total, const Vector& moment) {
    const T per_area = T(1) / sums.area;
    a = per_area * from_double<T>(Triple<double>{total});
    c = per_area * sums.X;
    const Tensor<T> J = sums.XX - sums.area * (c * transpose(c));
    b = inverse(trace(J) * identity<T>() - J) * from_double<T>(Triple<double>{moment});
  }

  T power(const FaceSums<T>& sums) const {
    return double_dot(a, sums.w) + double_dot(b, sums.Xw - cross(c, sums.w));
  }
};

}  // namespace

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

void add_slopes_of_loads(double factor, const NodalField& points, const std::vector<Quadrilateral>& faces,
                         const Vector& total, const Vector& moment, const NodalField& v, NodalField& slopes) {
  constexpr std::size_t count = sizeof(FaceSums<double>) / sizeof(double);
  using Numbers = std::array<double, count>;
  using Duals = std::array<Dual<double>, count>;
  const Triple<double> origin{points[at(faces.front()[0])]};
  Duals sums{};
  for (const auto& face : faces) {
    const auto own = std::bit_cast<Numbers>(
        sums_of(gauss_points_of(corners_of(points, face)), corners_of(v, face), origin));
    for (std::size_t k = 0; k < count; ++k) sums[k].value += own[k];
  }
  Numbers by_sums;
  for (std::size_t k = 0; k < count; ++k) {
    sums[k].slope = 1.0;
    const auto moved = std::bit_cast<FaceSums<Dual<double>>>(sums);
    by_sums[k] = Traction(moved, total, moment).power(moved).slope;
    sums[k].slope = 0.0;
  }
  for (const auto& face : faces) {
    const auto power = [&](const auto& of_face) {
      const auto own =
          std::bit_cast<Duals>(sums_of(of_face, corners_of(v, face), from_double<Dual<double>>(origin)));
      Dual<double> sum;
      for (std::size_t k = 0; k < count; ++k) sum = sum + Dual<double>(by_sums[k]) * own[k];
      return sum;
    };
    add_at_corners(factor, slopes_by_corners(corners_of(points, face), power), face, slopes);
  }
}

}  // namespace sandglass
