/// Ogden's law against closed forms, other laws, and its textbook form in long double.

#include "material/ogden.hpp"

#include <gtest/gtest.h>

#include <array>
#include <utility>
#include <vector>

#include "material/neo_hookean.hpp"
#include "support/current_tangent.hpp"
#include "support/dense_matrix.hpp"
#include "support/random_hexahedra.hpp"
#include "support/sample_law.hpp"

namespace sandglass::verification::ogden_test {
namespace {

constexpr double eps = std::numeric_limits<double>::epsilon();

/// Swine brain of Miller and Chinzei (J. Biomech. 35 (2002) 483) before it relaxes.
constexpr Ogden brain{.mu1 = 842.0, .alpha1 = -4.7, .K = 1e5};

/// Two terms that differ as much as those of soft materials.
constexpr Ogden two_terms{.mu1 = 600.0, .alpha1 = -4.7, .mu2 = 250.0, .alpha2 = 7.5, .K = 5e4};

Tensor<double> diagonal_gradient(double a, double b, double c) {
  return {{a - 1, 0, 0, 0, b - 1, 0, 0, 0, c - 1}};
}

/// sum_p 2 mu_p / alpha_p (a^alpha_p - b^alpha_p), the difference of two principal Kirchhoff stresses.
double stress_difference(const Ogden& law, double a, double b) {
  const auto term = [&](double mu, double alpha) {
    return 2 * mu / alpha * (std::pow(a, alpha) - std::pow(b, alpha));
  };
  return term(law.mu1, law.alpha1) + term(law.mu2, law.alpha2);
}

double closed_energy(const Ogden& law, double a, double b, double c) {
  const auto term = [&](double mu, double alpha) {
    return 2 * mu / (alpha * alpha) * (std::pow(a, alpha) + std::pow(b, alpha) + std::pow(c, alpha) - 3);
  };
  return term(law.mu1, law.alpha1) + term(law.mu2, law.alpha2);
}

/// The first Piola-Kirchhoff stress at principal stretches without change of volume, with the pressure at
/// which the stress along the third axis vanishes.
Tensor<double> stress_without_third(const Ogden& law, const Tensor<double>& H) {
  const VolumeChange<double> change = volume_change(H);
  const double lateral = law.weighted_kirchhoff(1.0, H, change, 0.0)(2, 2);
  return law.weighted_piola(1.0, H, change, -lateral);
}

/// Roundoff of a stress at H, as for every law.
template <class Law>
double tolerance(const Law& law, const Tensor<double>& H) {
  const auto bound = tangent_bound(law, H);
  return 256 * eps * (std::abs(bound.volumetric) + bound.gradient);
}

TEST(Ogden, has_the_moduli_of_its_parameters) {
  EXPECT_EQ(brain.shear_modulus(), 842.0);
  EXPECT_EQ(two_terms.shear_modulus(), 850.0);
  EXPECT_EQ(two_terms.bulk_modulus(), 5e4);
  for (const double nu : poisson_ratios) {
    const auto law = sample_law<Ogden>(nu);
    EXPECT_GT(law.mu2, 0.0);
    EXPECT_NEAR(young_modulus_of(law), sample_young_modulus, 1e-12 * sample_young_modulus);
  }
}

/// Nominal stress 2 mu / alpha (l^(alpha - 1) - l^(-alpha/2 - 1)), Miller and Chinzei's for a load too fast
/// for relaxation. From compression by a third, where it stiffens, to stretches beyond theirs.
TEST(Ogden, uniaxial_stress_of_the_brain) {
  for (const double l : {0.65, 0.7, 0.9, 1.0001, 1.2, 1.6, 2.5}) {
    const double side = 1 / std::sqrt(l);
    const auto H = diagonal_gradient(l, side, side);
    for (const auto& law : {brain, two_terms}) {
      const auto P = stress_without_third(law, H);
      const auto nominal = stress_difference(law, l, side) / l;
      EXPECT_NEAR(P(0, 0), nominal, tolerance(law, H));
      EXPECT_NEAR(P(1, 1), 0.0, tolerance(law, H));
      EXPECT_NEAR(law.isochoric_energy(H), closed_energy(law, l, side, side), tolerance(law, H));
    }
  }
  // In numbers: l = 0.7 gives -358.2979 (7.637323 - 0.617849) = -2515.063.
  const double side = 1 / std::sqrt(0.7);
  EXPECT_NEAR(stress_without_third(brain, diagonal_gradient(0.7, side, side))(0, 0), -2515.063, 1e-3);
}

TEST(Ogden, equibiaxial_stress) {
  for (const double l : {0.6, 0.95, 1.1, 1.8}) {
    const double thickness = 1 / (l * l);
    const auto H = diagonal_gradient(l, l, thickness);
    for (const auto& law : {brain, two_terms}) {
      const auto P = stress_without_third(law, H);
      EXPECT_NEAR(P(0, 0), stress_difference(law, l, thickness) / l, tolerance(law, H));
      EXPECT_NEAR(P(1, 1), P(0, 0), tolerance(law, H));
      EXPECT_NEAR(law.isochoric_energy(H), closed_energy(law, l, l, thickness), tolerance(law, H));
    }
  }
}

/// A shear by g stretches by l and 1/l with l - 1/l = g; its stress is dW/dg.
TEST(Ogden, simple_shear) {
  for (const double g : {-1.5, 1e-6, 0.4, 1.0}) {
    Tensor<double> H{};
    H(0, 1) = g;
    const double l = 0.5 * (g + std::sqrt(g * g + 4));
    for (const auto& law : {brain, two_terms}) {
      EXPECT_NEAR(law.piola(H)(0, 1), stress_difference(law, l, 1 / l) / (l + 1 / l), tolerance(law, H));
      EXPECT_NEAR(law.isochoric_energy(H), closed_energy(law, l, 1 / l, 1), tolerance(law, H));
    }
  }
}

TEST(Ogden, a_change_of_volume_leaves_only_pressure) {
  for (const double l : {0.5, 0.99, 1.2, 2.0}) {
    const auto H = diagonal_gradient(l, l, l);
    const double p = two_terms.K * (l * l * l - 1);
    EXPECT_LT(largest_entry(two_terms.piola(H) - (p * l * l) * identity<double>()),
              16 * eps * std::abs(p) * l * l);
    // The deviator of F F^T is only roundoff, and the energy its square.
    const double mu = two_terms.shear_modulus();
    EXPECT_LT(largest_entry(two_terms.isochoric_piola(H)), 4 * eps * mu / l);
    EXPECT_LT(two_terms.isochoric_energy(H), 4 * eps * eps * mu);
  }
}

/// With all exponents 2 this is the neo-Hookean law, which does not use principal frames: energy, stress and
/// tangent, at random and at equal stretches.
std::vector<Tensor<double>> gradients() {
  RandomGeometry random(21);
  std::vector<Tensor<double>> all{Tensor<double>{}, diagonal_gradient(1.3, 1.3, 1.3),
                                  diagonal_gradient(0.8, 1.4, 0.8), diagonal_gradient(1.0, 1.4, 1.4)};
  for (int n = 0; n < 50; ++n) {
    all.push_back(random.deformation(0.5, 2.0) - identity<double>());
    for (const double size : {1e-3, 1e-8, 1e-13}) all.push_back(random.tensor(size));
    const auto Q = random.rotation();
    const auto R = random.rotation();
    for (const double apart : {0.0, 1e-5, 1e-9, 1e-14}) {
      const auto U = diagonal_gradient(1.5, 0.7 + apart, 0.7) + identity<double>();
      all.push_back(R * Q * U * transpose(Q) - identity<double>());
    }
  }
  return all;
}

TEST(Ogden, with_exponents_2_is_the_neo_hookean_law) {
  const NeoHookean neo{.young_modulus = 3000.0, .poisson_ratio = 0.45};
  const double mu = neo.shear_modulus();
  const double K = neo.bulk_modulus();
  for (const auto& law : {Ogden{.mu1 = mu, .K = K}, Ogden{.mu1 = 0.3 * mu, .mu2 = 0.7 * mu, .K = K}}) {
    for (const auto& H : gradients()) {
      EXPECT_NEAR(law.energy(H), neo.energy(H), tolerance(neo, H) * std::min(1.0, largest_entry(H)));
      EXPECT_LT(largest_entry(law.piola(H) - neo.piola(H)), tolerance(neo, H));
      EXPECT_LT(largest_entry(current_tangent(law, H) - current_tangent(neo, H)), 8 * tolerance(neo, H));
    }
  }
}

/// tau = mu1 dev(bbar) - mu2 dev(bbar^-1) of Mooney and Rivlin, with exponents 2 and -2.
TEST(Ogden, with_exponents_2_and_minus_2_is_the_law_of_mooney_and_rivlin) {
  const Ogden law{.mu1 = 700.0, .alpha1 = 2.0, .mu2 = 300.0, .alpha2 = -2.0, .K = 2e4};
  const auto kirchhoff = [&](const auto& H) {
    using T = std::decay_t<decltype(H(0, 0))>;
    const Tensor<T> F = identity<T>() + H;
    const Tensor<T> b = F * transpose(F);
    const T root = inverse_cube_root(determinant(F));
    const T r2 = root * root;
    return T(law.mu1) * r2 * deviator(b) - T(law.mu2) / r2 * deviator(inverse(b));
  };
  for (const auto& H : gradients()) {
    const auto exact = kirchhoff(H);
    const auto found = law.weighted_kirchhoff(1.0, H, volume_change(H), 0.0);
    EXPECT_LT(largest_entry(found - exact), tolerance(law, H));
    for (std::size_t n = 0; n < 9; ++n) {
      const auto dual = along(H, unit<3, 3>(n));
      const auto change = law.weighted_kirchhoff(D(1.0), dual, volume_change(dual), D(0.0));
      EXPECT_LT(largest_entry(slope(change) - slope(kirchhoff(dual))), 8 * tolerance(law, H));
    }
    const auto F = identity<double>() + H;
    const auto b = F * transpose(F);
    const double r2 = std::pow(determinant(F), -2.0 / 3.0);
    const double W = 0.5 * law.mu1 * (r2 * trace(b) - 3) + 0.5 * law.mu2 * (trace(inverse(b)) / r2 - 3);
    EXPECT_NEAR(law.isochoric_energy(H), W, tolerance(law, H));
  }
}

/// W = mu sum (ln lbar_a)^2: the limit of vanishing exponents, and exponents close to it.
TEST(Ogden, with_exponent_0_is_the_law_of_hencky) {
  for (const double alpha : {0.0, 1e-30, 1e-12}) {
    const Ogden law{.mu1 = 500.0, .alpha1 = alpha, .mu2 = 300.0, .alpha2 = 0.0, .K = 1e4};
    const auto H = diagonal_gradient(1.7, 0.8, 1.1);
    const double mean = std::log(1.7 * 0.8 * 1.1) / 3;
    double W = 0;
    const auto P = law.isochoric_piola(H);
    for (int a = 0; a < 3; ++a) {
      const double x = std::log(1 + H(a, a)) - mean;
      W += 800.0 * x * x;
      EXPECT_NEAR(P(a, a), 1600.0 * x / (1 + H(a, a)), 1e-9);
    }
    EXPECT_NEAR(law.isochoric_energy(H), W, 1e-9);
  }
}

/// The textbook form in principal stretches and axes, of F = V R in long double; rounding to H costs 1e-16
/// |H|.
TEST(Ogden, agrees_with_the_textbook_form_in_long_double) {
  using Real = long double;
  RandomGeometry random(13);
  for (const double size : {0.3, 1e-3, 1e-6}) {
    const auto any = [&](double most) { return static_cast<Real>(random.uniform(-most, most)); };
    for (int n = 0; n < 100; ++n) {
      const Tensor<Real> axes = rotation_of(any(1), any(1), any(1), any(1)),
                         R = rotation_of(Real(1), any(size), any(size), any(size));
      const std::array<Real, 3> stretches{1 + any(size), 1 + any(size), 1 + any(size)};
      const auto along_axes = [&](const std::array<Real, 3>& values) {
        Tensor<Real> a{};
        for (int i = 0; i < 3; ++i) a(i, i) = values[static_cast<std::size_t>(i)];
        return axes * a * transpose(axes);
      };
      const Tensor<Real> F = along_axes(stretches) * R;
      Tensor<double> H;
      for (int i = 0; i < 3; ++i) {
        for (int j = 0; j < 3; ++j) H(i, j) = static_cast<double>(F(i, j) - (i == j ? 1 : 0));
      }
      const Real J = stretches[0] * stretches[1] * stretches[2];
      std::array<Real, 3> t{};
      Real W = 0;
      for (const auto& [mu, alpha] : {std::pair<Real, Real>{two_terms.mu1, two_terms.alpha1},
                                      std::pair<Real, Real>{two_terms.mu2, two_terms.alpha2}}) {
        std::array<Real, 3> power;
        for (std::size_t a = 0; a < 3; ++a) power[a] = std::pow(stretches[a] / std::cbrt(J), alpha);
        const Real sum = power[0] + power[1] + power[2];
        for (std::size_t a = 0; a < 3; ++a) t[a] += 2 * mu / alpha * (power[a] - sum / 3);
        W += 2 * mu / (alpha * alpha) * (sum - 3);
      }
      const Tensor<Real> tau = along_axes(t);
      const auto found = two_terms.weighted_kirchhoff(1.0, H, volume_change(H), 0.0);
      // Roundoff of the strain enters tau to first order, W to second order. The oracle's own roundoff is
      // relative to 1.
      const double stiffness = tangent_bound(two_terms, H).gradient;
      const double oracle = 1e-17 * stiffness;
      for (int i = 0; i < 3; ++i) {
        for (int j = 0; j < 3; ++j) {
          EXPECT_NEAR(found(i, j), static_cast<double>(tau(i, j)), 64 * eps * stiffness * size + oracle);
        }
      }
      EXPECT_NEAR(two_terms.isochoric_energy(H), static_cast<double>(W),
                  64 * eps * stiffness * size * size + oracle);
    }
  }
}

/// Not only for the exponents of the sample: from strong compression to strong stretch, at random, equal and
/// nearly equal stretches. Volume is constant, so that pressure adds nothing to the bound: for exponents
/// between -1 and 2 shear determines it, for others stretch along the axes.
TEST(Ogden, tangent_bound_holds_for_every_exponent) {
  RandomGeometry random(31);
  const auto holds = [](const Ogden& law, const Tensor<double>& H) {
    const double root = std::cbrt(determinant(identity<double>() + H));
    const Tensor<double> isochoric = (1 / root) * (identity<double>() + H) - identity<double>();
    const auto A = current_tangent(law, isochoric);
    const auto bound = tangent_bound(law, isochoric);
    EXPECT_GT(eigenvalues(slack(bound, 0.5 * (A + transpose(A)))).front(), -1e-12 * largest_entry(A))
        << law.alpha1 << " " << law.alpha2;
  };
  for (const double alpha : {-8.0, -4.7, -2.0, -0.5, 0.0, 0.3, 1.0, 1.5, 2.0, 4.0, 10.0}) {
    for (const double mu2 : {0.0, 100.0}) {
      const Ogden law{.mu1 = 700.0, .alpha1 = alpha, .mu2 = mu2, .alpha2 = 5.0, .K = 2000.0};
      for (int n = 0; n < 200; ++n) holds(law, random.deformation(0.2, 4.0) - identity<double>());
      for (const auto& H : gradients()) holds(law, H);
    }
  }
}

}  // namespace
}  // namespace sandglass::verification::ogden_test
