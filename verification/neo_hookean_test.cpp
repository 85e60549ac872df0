/// The neo-Hookean law in closed form.

#include <gtest/gtest.h>

#include "material/laws.hpp"
#include "support/random_hexahedra.hpp"
#include "support/sample_law.hpp"

namespace sandglass::verification::neo_hookean_test {
namespace {

constexpr double eps = std::numeric_limits<double>::epsilon();

double neo_hookean_lateral(const NeoHookean& law, double stretch) {
  // The stretch without lateral stress, by bisection: the stress grows with the stretch.
  double low = 0.1;
  double high = 3.0;
  for (int n = 0; n < 200; ++n) {
    const double middle = 0.5 * (low + high);
    const double J = stretch * middle * middle;
    const double I1 = stretch * stretch + 2 * middle * middle;
    const double sigma = law.shear_modulus() * std::pow(J, -5.0 / 3.0) * (middle * middle - I1 / 3) +
                         law.bulk_modulus() * (J - 1);
    (sigma < 0 ? low : high) = middle;
  }
  return 0.5 * (low + high);
}

Tensor<double> diagonal_gradient(double a, double b, double c) {
  return {{a - 1, 0, 0, 0, b - 1, 0, 0, 0, c - 1}};
}

TEST(NeoHookean, has_the_moduli_of_its_parameters) {
  for (const double nu : poisson_ratios) {
    const auto law = sample_law<NeoHookean>(nu);
    const double mu = law.shear_modulus();
    const double K = law.bulk_modulus();
    EXPECT_NEAR(young_modulus_of(law), sample_young_modulus, 1e-12 * sample_young_modulus);
    EXPECT_NEAR((3 * K - 2 * mu) / (2 * (3 * K + mu)), nu, 1e-14);
  }
}

TEST(NeoHookean, uniaxial_stretch) {
  for (const double nu : poisson_ratios) {
    const auto law = sample_law<NeoHookean>(nu);
    for (const double stretch : {0.5, 0.9, 1.1, 2.0}) {
      const double lateral = neo_hookean_lateral(law, stretch);
      const double J = stretch * lateral * lateral;
      const double I1 = stretch * stretch + 2 * lateral * lateral;
      const auto H = diagonal_gradient(stretch, lateral, lateral);
      const auto P = law.piola(H);
      const double mu = law.shear_modulus();
      const double axial = mu * std::pow(J, -2.0 / 3.0) * (stretch - I1 / 3 / stretch) +
                           law.bulk_modulus() * (J - 1) * J / stretch;
      const double tolerance = 1e-12 * law.bulk_modulus();
      EXPECT_NEAR(P(0, 0), axial, tolerance);
      EXPECT_NEAR(P(1, 1), 0.0, tolerance);
      EXPECT_NEAR(P(2, 2), 0.0, tolerance);
      const double W =
          0.5 * mu * (std::pow(J, -2.0 / 3.0) * I1 - 3) + 0.5 * law.bulk_modulus() * (J - 1) * (J - 1);
      EXPECT_NEAR(law.energy(H), W, tolerance);
    }
  }
}

TEST(NeoHookean, incompressible_limit_of_uniaxial_stretch) {
  // 1 - 2 nu = 2e-9: K = 1e9 E / 6; J - 1 is of order mu/K, so the limit is reached to a few 1e-9.
  const auto law = sample_law<NeoHookean>(0.5 - 1e-9);
  const double lateral = neo_hookean_lateral(law, 2.0);
  EXPECT_NEAR(lateral - 1.0, -0.29289321881345254, 1e-8);  // 1/sqrt(2) - 1
  const double mu = law.shear_modulus();
  const double axial = mu * (2.0 - 1.0 / 4.0);
  const auto P = law.piola(diagonal_gradient(2.0, lateral, lateral));
  // The lateral stretch is rounded to eps, which K turns into stress: eps K = 1e-16 * 1e9 E / 6.
  EXPECT_NEAR(P(0, 0), axial, 1e-6 * axial);
}

TEST(NeoHookean, simple_shear) {
  const auto law = sample_law<NeoHookean>(0.49);
  const double mu = law.shear_modulus();
  for (const double g : {-1.5, 1e-3, 0.4, 1.0}) {
    Tensor<double> H{};
    H(0, 1) = g;
    const auto P = law.piola(H);
    // F^-T = I - g e2 e1, I1 = 3 + g^2, J = 1
    const Tensor<double> exact{{-mu * g * g / 3, mu * g, 0,                    //
                                mu * (1 + g * g / 3) * g, -mu * g * g / 3, 0,  //
                                0, 0, -mu * g * g / 3}};
    EXPECT_LT(largest_entry(P - exact), 64 * eps * mu * (1 + std::abs(g * g * g)));
    EXPECT_NEAR(law.energy(H), 0.5 * mu * g * g, 64 * eps * mu * (1 + g * g));
  }
}

TEST(NeoHookean, change_of_volume) {
  const auto law = sample_law<NeoHookean>(0.45);
  const double K = law.bulk_modulus();
  for (const double stretch : {0.5, 0.99, 1.2, 2.0}) {
    const double J = stretch * stretch * stretch;
    const auto H = diagonal_gradient(stretch, stretch, stretch);
    const auto P = law.piola(H);
    const auto exact = (K * (J - 1) * stretch * stretch) * identity<double>();
    EXPECT_LT(largest_entry(P - exact), 64 * eps * K * J * stretch * stretch);
    EXPECT_NEAR(law.energy(H), 0.5 * K * (J - 1) * (J - 1), 64 * eps * K * J * J);
  }
}

/// The textbook form in F, evaluated in long double, where its cancellation costs 1e-19/|H|.
TEST(NeoHookean, agrees_with_the_textbook_form_in_long_double) {
  using Real = long double;
  RandomGeometry random(13);
  for (const double size : {0.3, 1e-3, 1e-6}) {
    for (int n = 0; n < 100; ++n) {
      const auto law = sample_law<NeoHookean>(poisson_ratios[static_cast<std::size_t>(n) % 4]);
      const auto H = random.tensor(size);
      const auto F = identity<Real>() + from_double<Real>(H);
      const Real J = determinant(F);
      const Real I1 = double_dot(F, F);
      const Real scale = static_cast<Real>(law.shear_modulus()) / std::cbrt(J * J);
      const Real bulk = static_cast<Real>(law.bulk_modulus()) * (J - 1);
      const Tensor<Real> exact = scale * F + (bulk - scale * I1 / (3 * J)) * cofactor(F);
      Tensor<double> difference{};
      const auto P = law.piola(H);
      for (std::size_t k = 0; k < 9; ++k) {
        difference.entries[k] = P.entries[k] - static_cast<double>(exact.entries[k]);
      }
      const double oracle_error = 1e-18 * (law.bulk_modulus() + law.shear_modulus());
      EXPECT_LT(largest_entry(difference), 64 * eps * size * law.bulk_modulus() + oracle_error);
    }
  }
}

}  // namespace
}  // namespace sandglass::verification::neo_hookean_test
