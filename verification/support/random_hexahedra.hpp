#pragma once

#include <cmath>
#include <cstdint>
#include <random>

#include "mesh/hexahedron.hpp"

namespace sandglass::verification {

/// Random numbers, rotations, hexahedra and deformations, equal on every machine: the standard defines the
/// The rotation by a quaternion of any length.
template <class T>
Tensor<T> rotation_of(T w, T x, T y, T z) {
  const T s = T(2) / (w * w + x * x + y * y + z * z);
  return {{1 - s * (y * y + z * z), s * (x * y - z * w), s * (x * z + y * w),  //
           s * (x * y + z * w), 1 - s * (x * x + z * z), s * (y * z - x * w),  //
           s * (x * z - y * w), s * (y * z + x * w), 1 - s * (x * x + y * y)}};
}

/// engine's bits but not std::uniform_real_distribution, which a conversion of our own replaces.
class RandomGeometry {
 public:
  explicit RandomGeometry(std::uint64_t seed) : engine_(seed) {}

  double uniform(double low, double high) {
    return low + (high - low) * static_cast<double>(engine_() >> 11U) * 0x1p-53;
  }

  /// A tensor with entries in [-size, size].
  Tensor<double> tensor(double size) {
    Tensor<double> a{};
    for (auto& entry : a.entries) entry = uniform(-size, size);
    return a;
  }

  /// A rotation about an arbitrary axis by an arbitrary angle, from a random unit quaternion.
  Tensor<double> rotation() {
    double w = 0.0, x = 0.0, y = 0.0, z = 0.0, square = 0.0;
    while (square < 0.01 || square > 1.0) {  // inside the unit ball: no direction is preferred
      w = uniform(-1.0, 1.0);
      x = uniform(-1.0, 1.0);
      y = uniform(-1.0, 1.0);
      z = uniform(-1.0, 1.0);
      square = w * w + x * x + y * y + z * z;
    }
    return rotation_of(w, x, y, z);
  }

  /// A deformation gradient: rotation times stretches of the given range along random axes.
  Tensor<double> deformation(double smallest_stretch, double largest_stretch) {
    const Tensor<double> axes = rotation();
    Tensor<double> stretch{};
    for (int i = 0; i < 3; ++i) stretch(i, i) = uniform(smallest_stretch, largest_stretch);
    return rotation() * (axes * stretch * transpose(axes));
  }

  /// A distorted hexahedron: corners of a unit cube moved by up to a quarter of the edge in each direction,
  /// then stretched, sheared, rotated, moved, and scaled to millimetres, metres or kilometres.
  NodalVectors<double> hexahedron() {
    for (;;) {
      NodalVectors<double> X{};
      for (int I = 0; I < 8; ++I) {
        for (int i = 0; i < 3; ++i) X(I, i) = 0.5 * corner_signs(I, i) + uniform(-0.25, 0.25);
      }
      if (smallest_measure(X) < 0.02) continue;  // a quarter can fold a corner; a cube's corner has 1/8
      return placed(X);
    }
  }

  /// A parallelepiped made in the same way from an undistorted cube.
  NodalVectors<double> parallelepiped() { return placed(0.5 * corner_signs); }

  /// Displacements of a hexahedron: a large random deformation and rotation, a translation, and independent
  /// movements of the corners by up to `waviness` of its size. No Gauss point inverts.
  NodalVectors<double> displacements(const NodalVectors<double>& X, double smallest_stretch,
                                     double largest_stretch, double waviness) {
    const double size = std::cbrt(mean_gradient(X).volume);
    for (;;) {
      const Tensor<double> F = deformation(smallest_stretch, largest_stretch);
      NodalVectors<double> x = X * transpose(F);
      const double shift = uniform(-2.0, 2.0) * size;
      for (auto& entry : x.entries) entry += shift + waviness * size * uniform(-1.0, 1.0);
      if (smallest_ratio(X, x) > 0.1) return x - X;
    }
  }

 private:
  static double smallest_measure(const NodalVectors<double>& X) {
    double smallest = INFINITY;
    for (const auto& xi : gauss_points()) smallest = std::min(smallest, determinant(parent_jacobian(X, xi)));
    return smallest;
  }

  /// The smallest det F at the Gauss points.
  static double smallest_ratio(const NodalVectors<double>& X, const NodalVectors<double>& x) {
    double smallest = INFINITY;
    for (const auto& xi : gauss_points()) {
      smallest =
          std::min(smallest, determinant(parent_jacobian(x, xi)) / determinant(parent_jacobian(X, xi)));
    }
    return smallest;
  }

  NodalVectors<double> placed(const NodalVectors<double>& X) {
    constexpr std::array<double, 3> sizes{1e-3, 1.0, 1e3};
    const double size = sizes[engine_() % 3];
    Tensor<double> map = identity<double>();
    for (int i = 0; i < 3; ++i) {
      map(i, i) = uniform(0.5, 2.0);
      for (int j = i + 1; j < 3; ++j) map(i, j) = uniform(-0.5, 0.5);
    }
    NodalVectors<double> placed = X * transpose(size * (rotation() * map));
    const Vector3 shift{uniform(-3, 3) * size, uniform(-3, 3) * size, uniform(-3, 3) * size};
    for (int I = 0; I < 8; ++I) {
      for (int i = 0; i < 3; ++i) placed(I, i) += shift[static_cast<std::size_t>(i)];
    }
    return placed;
  }

  using Vector3 = std::array<double, 3>;
  std::mt19937_64 engine_;
};

/// The largest absolute entry.
template <class T, int R, int C>
double largest_entry(const Matrix<T, R, C>& a) {
  double largest = 0.0;
  for (const auto& entry : a.entries) largest = std::max(largest, static_cast<double>(std::abs(entry)));
  return largest;
}

}  // namespace sandglass::verification
