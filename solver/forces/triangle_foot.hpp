#pragma once

#include <algorithm>
#include <array>
#include <cmath>

#include "mesh/vectors.hpp"

namespace sandglass {

/// The weights of the corners (m) of a triangle at the projection of x (m) onto its plane; they add up to
/// one.
inline Vector plane_weights(const std::array<Vector, 3>& X, const Vector& x) {
  const Vector ab = difference(X[1], X[0]), ac = difference(X[2], X[0]), from = difference(x, X[0]);
  const Vector normal = cross(ab, ac);
  const double inverse = 1.0 / dot(normal, normal);
  const double b = dot(cross(from, ac), normal) * inverse, c = dot(cross(ab, from), normal) * inverse;
  return {1.0 - b - c, b, c};
}

/// Whether the point with these weights is within its triangle, and not on its rim.
inline bool is_within(const Vector& weights) {
  return weights[0] > 0.0 && weights[1] > 0.0 && weights[2] > 0.0;
}

/// The share of the way from a to b (m) at which an edge is closest to x.
inline double share_of_edge(const Vector& a, const Vector& b, const Vector& x) {
  const Vector edge = difference(b, a);
  return std::clamp(dot(difference(x, a), edge) / dot(edge, edge), 0.0, 1.0);
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
    if (is_within(inside)) return {inside, 0};
    TriangleFoot nearest{{}, 0};
    double least = INFINITY;
    for (std::size_t i = 0; i < 3; ++i) {
      const std::size_t j = (i + 1) % 3;
      const double t = share_of_edge(X[i], X[j], x);
      const Vector from = difference(x, sum(X[i], t, difference(X[j], X[i])));
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
