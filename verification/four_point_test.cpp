/// The four-point element between one point and eight, and the constants of the levels of an adaptive method.

#include <gtest/gtest.h>

#include <bit>
#include <set>

#include "support/level_kernels.hpp"
#include "support/orderings.hpp"
#include "support/random_hexahedra.hpp"
#include "support/single_element.hpp"

namespace sandglass::verification::four_point_test {
namespace {

template <class Kernel>
double energy_of(const NodalVectors<double>& X, const NodalVectors<double>& u) {
  SingleElement<Kernel, LevelLaw> element(X, level_law());
  element.to(u);
  const auto energy = element.energy();
  return energy.strain + energy.hourglass;
}

/// A cube of edge 2 m whose corners are at their signs, deformed by F and by amplitudes of the four hourglass
/// modes.
NodalVectors<double> cube() {
  return corner_signs;
}
NodalVectors<double> displaced(const NodalVectors<double>& X, const Tensor<double>& F,
                               const HourglassModes<double>& amplitudes) {
  return X * transpose(F - identity<double>()) + hourglass_base_vectors() * amplitudes;
}

/// The gradient at each point is the mean one plus the contribution of the hourglass displacements. Either
/// way roundoff is below 100 eps of the largest gradient, which is of order one.
TEST(FourPoint, gradients_are_the_mean_and_what_hourglass_displacements_add) {
  RandomGeometry random(23);
  for (int n = 0; n < 20; ++n) {
    const NodalVectors<double> X = random.hexahedron();
    const auto element = FourPoint::precompute(X);
    ElementMotion<double> motion{};
    motion.u = to_modes(random.displacements(X, 0.7, 1.4, 0.2));
    const auto now = FourPoint::deformation<LastModeControl>(motion, element);
    const Tensor<double> mean = 0.25 * ((now.H[0] + now.H[1]) + (now.H[2] + now.H[3]));
    for (std::size_t p = 0; p < 4; ++p) {
      const Tensor<double> added = transpose(now.q) * FourPoint::fluctuation(p, element);
      for (int i = 0; i < 3; ++i) {
        for (int j = 0; j < 3; ++j) EXPECT_NEAR(now.H[p](i, j), mean(i, j) + added(i, j), 1e-13);
      }
    }
  }
}

/// On a parallelepiped the energies of four and eight points agree to second order in the first three
/// hourglass modes, at any mean deformation: half as large modes divide the difference by eight or more.
TEST(FourPoint, knows_the_second_variation_of_eight_points) {
  RandomGeometry random(11);
  for (int n = 0; n < 20; ++n) {
    const NodalVectors<double> X = cube() * transpose(random.deformation(0.5, 2.0));
    const Tensor<double> F = random.deformation(0.8, 1.25);
    HourglassModes<double> q{};
    for (int a = 0; a < 3; ++a) {
      for (int i = 0; i < 3; ++i) q(a, i) = random.uniform(-0.02, 0.02);
    }
    const double none = energy_of<EightPointKernel>(X, displaced(X, F, {}));
    const auto difference = [&](double share) {
      const auto u = displaced(X, F, share * q);
      return energy_of<FourPointKernel>(X, u) - energy_of<EightPointKernel>(X, u);
    };
    const double second_order = energy_of<EightPointKernel>(X, displaced(X, F, q)) - none;
    EXPECT_LT(std::abs(difference(1.0)), 0.1 * std::abs(second_order));
    // A third-order difference, plus a fourth-order one of a few percent at this size.
    EXPECT_LT(std::abs(difference(0.5)), std::abs(difference(1.0)) / 8.0 * 1.3 + 1e-12 * second_order);
  }
}

/// With the points near the other four corners, the energy of an element differs to third order.
TEST(FourPoint, other_corners_differ_to_third_order) {
  RandomGeometry random(13);
  for (int n = 0; n < 20; ++n) {
    const NodalVectors<double> X = cube() * transpose(random.deformation(0.5, 2.0));
    const Tensor<double> F = random.deformation(0.8, 1.25);
    HourglassModes<double> q{};
    for (auto& entry : q.entries) entry = random.uniform(-0.02, 0.02);
    const auto difference = [&](double share) {
      ElementMotion<double> motion{};
      motion.u = to_modes(displaced(X, F, share * q));
      auto element = FourPointKernel::precompute(X, level_law(), {});
      const auto strain = [&] { return FourPointKernel::energy(motion, element, {}, level_law()).strain; };
      const double own = strain();
      element.body.reach = -element.body.reach;
      return strain() - own;
    };
    EXPECT_NE(difference(1.0), 0.0);
    EXPECT_NEAR(difference(0.5) / difference(1.0), 0.125, 0.03);  // odd: plus a fifth-order term
  }
}

/// The positions of the corners that have points do not depend on the numbering, also where edges are equal,
/// for elements with edges of different lengths in every orientation and size.
TEST(FourPoint, shape_decides_which_corners_have_points) {
  const auto chosen = [](const NodalVectors<double>& X) {
    const double side = FourPoint::side(to_modes(X));
    std::set<std::array<double, 3>> places;
    for (int I = 0; I < 8; ++I) {
      const double product = corner_signs(I, 0) * corner_signs(I, 1) * corner_signs(I, 2);
      if (product * side < 0.0) places.insert({X(I, 0), X(I, 1), X(I, 2)});
    }
    return places;
  };
  RandomGeometry random(17);
  std::vector<NodalVectors<double>> shapes{cube()};
  for (const double length : {0.5, 2.0}) {
    NodalVectors<double> X = cube();
    for (int I = 0; I < 8; ++I) X(I, 2) *= length;
    shapes.push_back(X);
  }
  for (int n = 0; n < 20; ++n) shapes.push_back(random.hexahedron());
  for (const auto& X : shapes) {
    for (const auto& ordering : proper_orderings()) EXPECT_EQ(chosen(reordered(X, ordering)), chosen(X));
  }
  for (int n = 0; n < 20; ++n) {
    const NodalVectors<double> X = random.hexahedron();
    const double side = FourPoint::side(to_modes(X));
    EXPECT_EQ(FourPoint::side(to_modes(1e-3 * X * transpose(random.rotation()))), side);
  }
}

/// The last mode on a cube of edge a: |d(xi eta zeta)/dX|^2 has the mean 3 (2/a)^2 / 9, so that an amplitude
/// A has the energy 10/9 mu/2 a^3 (4/3)/a^2 A^2 = 20/27 mu a A^2.
TEST(FourPoint, last_mode_of_a_cube_in_closed_form) {
  const double edge = 0.3, amplitude = 1e-3;
  HourglassModes<double> q{};
  q(3, 1) = amplitude;
  const NodalVectors<double> X = 0.5 * edge * cube();
  const double energy = energy_of<FourPointKernel>(X, displaced(X, identity<double>(), q));
  EXPECT_NEAR(energy / (20.0 / 27.0 * level_law().shear_modulus() * edge * amplitude * amplitude), 1.0, 1e-9);
}

template <class Kernel>
void expect_same_constants(const NodalVectors<double>& X) {
  using Element = typename Kernel::template Element<double>;
  using Numbers = std::array<double, sizeof(Element) / sizeof(double)>;
  const auto set_up = std::bit_cast<Numbers>(Kernel::precompute(X, level_law(), {}));
  const auto anew = std::bit_cast<Numbers>(Kernel::constants(to_modes(X), level_law(), {}));
  double largest = 0.0;
  for (const double number : set_up) largest = std::max(largest, std::abs(number));
  for (std::size_t n = 0; n < set_up.size(); ++n) {
    // Roundoff of the closed form, whose terms are as large as the squares of edges over the volume.
    EXPECT_NEAR(anew[n], set_up[n], 1e-11 * std::max(std::abs(set_up[n]), 1e-3 * largest)) << n;
  }
}

TEST(Levels, constants_from_coordinates_are_those_of_the_set_up) {
  RandomGeometry random(5);
  for (int n = 0; n < 10; ++n) {
    NodalVectors<double> X = cube();
    for (auto& x : X.entries) x += random.uniform(-0.3, 0.3);
    expect_same_constants<OnePointKernel>(X);
    expect_same_constants<FourPointKernel>(X);
    expect_same_constants<EightPointKernel>(X);
  }
}

}  // namespace
}  // namespace sandglass::verification::four_point_test
