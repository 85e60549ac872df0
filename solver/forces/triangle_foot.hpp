#pragma once

#include <algorithm>
#include <array>
#include <cmath>

#include "mesh/vectors.hpp"

namespace sandglass {

/// The weights of the corners (m) of a triangle at the projection of x (m) onto its plane; they add up to
/// one.
inline Vector plane_weights(const std::array<Vector, 3>& X, const Vector& x) {
  const Vector normal = cross(difference(X[1], X[0]), difference(X[2], X[0]));
  const double area = dot(normal, normal);
  Vector weights{};
  for (std::size_t i = 0; i < 3; ++i) {
    const Vector &p = X[(i + 1) % 3], &q = X[(i + 2) % 3];
    weights[i] = dot(cross(difference(q, p), difference(x, p)), normal) / area;
  }
  return weights;
}

/// The mean (m) of the corners of a triangle with these weights.
inline Vector point_of(const std::array<Vector, 3>& X, const Vector& weights) {
  return sum(sum(sum({}, weights[0], X[0]), weights[1], X[1]), weights[2], X[2]);
}

/// The weights of the corners at the point of a triangle that is closest to x, and the feature on which it
/// is: 0 the face, 1 to 3 the edges that start at corners 0 to 2, 4 to 6 the corners.
struct TriangleFoot {
  Vector weights;
  std::size_t feature;

  static TriangleFoot of(const std::array<Vector, 3>& X, const Vector& x) {
    const Vector inside = plane_weights(X, x);
    if (inside[0] > 0.0 && inside[1] > 0.0 && inside[2] > 0.0) return {inside, 0};
    TriangleFoot nearest{{}, 0};
    double least = INFINITY;
    for (std::size_t i = 0; i < 3; ++i) {
      const std::size_t j = (i + 1) % 3;
      const Vector edge = difference(X[j], X[i]);
      const double t = std::clamp(dot(difference(x, X[i]), edge) / dot(edge, edge), 0.0, 1.0);
      const Vector from = difference(x, sum(X[i], t, edge));
      const double square = dot(from, from);
      if (square >= least) continue;
      least = square;
      nearest = {{}, t == 0.0 ? 4 + i : t == 1.0 ? 4 + j : 1 + i};
      nearest.weights[i] = 1.0 - t;
      nearest.weights[j] = t;
    }
    return nearest;
  }
};

}  // namespace sandglass
