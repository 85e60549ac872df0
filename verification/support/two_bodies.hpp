#pragma once

#include "mesh/vectors.hpp"
#include "support/obstacles.hpp"

/// Two bodies in one mesh.
namespace sandglass::verification {

/// Two boxes one above the other; the lower has its foot at z = 0, and the sets "lower" and "upper" are their
/// nodes, "foot", "under", "over" and "top" their horizontal faces from below.
struct TwoBodies {
  Mesh mesh;
  NodeSets sets;
  Case description;

  TwoBodies(Mesh lower, Mesh upper, const AnyLaw& law, double density = 1000.0)
      : mesh(std::move(lower)), description(plain_case(law, density)) {
    const auto first = static_cast<int>(mesh.points.size());
    add("lower", 0, first, "foot", "under");
    mesh.points.insert(mesh.points.end(), upper.points.begin(), upper.points.end());
    for (Hexahedron cell : upper.cells) {
      for (int& node : cell) node += first;
      mesh.cells.push_back(cell);
    }
    add("upper", first, static_cast<int>(mesh.points.size()), "over", "top");
    description.quasi_static = false;
  }

  Scene scene() const { return make_scene(description, mesh, sets); }

 private:
  void add(const std::string& name, int first, int end, const std::string& low_name,
           const std::string& high_name) {
    double low = INFINITY, high = -INFINITY;
    for (int n = first; n < end; ++n) {
      sets[name].push_back(n);
      low = std::min(low, mesh.points[at(n)][2]);
      high = std::max(high, mesh.points[at(n)][2]);
    }
    for (const int n : sets[name]) {
      if (mesh.points[at(n)][2] < low + 1e-9) sets[low_name].push_back(n);
      if (mesh.points[at(n)][2] > high - 1e-9) sets[high_name].push_back(n);
    }
  }
};

/// The mesh, moved.
inline Mesh moved(Mesh mesh, const Vector& by) {
  for (Vector& X : mesh.points) X = sum(X, 1.0, by);
  return mesh;
}

/// A ball of hexahedra: a cube whose shells are blown up.
inline Mesh ball(double radius, int n) {
  return lattice({n, n, n}, [&](const Vector& s) {
    Vector x{2.0 * s[0] - 1.0, 2.0 * s[1] - 1.0, 2.0 * s[2] - 1.0};
    const double shell = std::max({std::abs(x[0]), std::abs(x[1]), std::abs(x[2])});
    if (shell == 0.0) return Vector{};
    const double sphere = radius * shell / length(x), cube = 0.6 * radius;
    const double round = shell * shell;
    for (double& one : x) one *= round * sphere + (1.0 - round) * cube;
    return x;
  });
}

inline constexpr std::array both_methods{Contact::Method::penalty, Contact::Method::kinematic};

/// The contact of the two bodies.
inline Contact pair_of(const std::string& set, const std::string& other, Contact::Method method,
                       double friction = 0.0) {
  return {.label = "pair", .set = set, .other = other, .friction = friction, .method = method};
}

}  // namespace sandglass::verification
