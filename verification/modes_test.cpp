// The modal form of nodal values: butterflies against the sums that they replace.
#include "element/modes.hpp"

#include <gtest/gtest.h>

#include "mesh/hexahedron.hpp"
#include "support/random_hexahedra.hpp"

namespace sandglass::verification::modes_test {
namespace {

constexpr double eps = 0x1p-52;

/// Nodal signs of the seven modes: the parent coordinates, then the hourglass base vectors.
Matrix<double, 8, 7> signs() {
  Matrix<double, 8, 7> s{};
  for (int I = 0; I < 8; ++I) {
    for (int i = 0; i < 3; ++i) s(I, i) = corner_signs(I, i);
    for (int a = 0; a < 4; ++a) s(I, 3 + a) = hourglass_base_vectors()(I, a);
  }
  return s;
}

/// Sums of eight numbers: in any order the error is below 8 eps times the sum of absolute values.
TEST(Modes, are_the_sums_over_nodes_that_their_names_say) {
  RandomGeometry random(3);
  for (int sample = 0; sample < 100; ++sample) {
    const NodalVectors<double> u = random.hexahedron();
    const Modes<double> exact = transpose(signs()) * u;
    const Modes<double> modes = to_modes(u);
    const double size = std::sqrt(double_dot(u, u));
    for (std::size_t k = 0; k < 21; ++k) EXPECT_NEAR(modes.entries[k], exact.entries[k], 32 * eps * size);
  }
}

TEST(Modes, from_modes_is_the_transpose_of_to_modes) {
  for (int m = 0; m < 7; ++m) {
    for (int i = 0; i < 3; ++i) {
      Modes<double> unit{};
      unit(m, i) = 1.0;
      const NodalVectors<double> nodal = from_modes(unit);
      for (int I = 0; I < 8; ++I) {
        for (int j = 0; j < 3; ++j) EXPECT_EQ(nodal(I, j), i == j ? signs()(I, m) : 0.0) << "mode " << m;
      }
    }
  }
}

/// The one-point element omits the mean gradient of the mode xi eta zeta. On each face this mode is bilinear
/// and the face's normal has no such part, so that the integral over the surface vanishes on every trilinear
/// hexahedron.
TEST(Modes, the_last_mode_has_no_mean_gradient) {
  RandomGeometry random(5);
  for (int sample = 0; sample < 1000; ++sample) {
    const NodalVectors<double> h = mean_gradient(random.hexahedron()).h;
    const Modes<double> modes = to_modes(h);
    const double size = std::sqrt(double_dot(h, h));
    for (int i = 0; i < 3; ++i) EXPECT_NEAR(modes(6, i), 0.0, 64 * eps * size);
  }
}

}  // namespace
}  // namespace sandglass::verification::modes_test
