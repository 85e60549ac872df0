/// The laws against closed forms: textbook stresses in long double, and solutions of one line.

#include <gtest/gtest.h>

#include "material/laws.hpp"
#include "material/small_strain.hpp"
#include "support/current_tangent.hpp"
#include "support/dense_matrix.hpp"
#include "support/derivatives.hpp"
#include "support/random_hexahedra.hpp"
#include "support/sample_law.hpp"

namespace sandglass::verification::law_oracle_test {
namespace {

constexpr double eps = std::numeric_limits<double>::epsilon();
using Real = long double;

Tensor<Real> with_all_digits(const Tensor<double>& a) {
  Tensor<Real> result{};
  for (std::size_t n = 0; n < 9; ++n) result.entries[n] = a.entries[n];
  return result;
}

/// a - tr(a)/3 I; the kernels multiply by the double nearest to 1/3, which has only 16 digits.
Tensor<Real> exact_deviator(const Tensor<Real>& a) {
  return a - (trace(a) / 3) * identity<Real>();
}

/// P = J sigma F^-T = sigma cof F.
Tensor<Real> piola_of(const Tensor<Real>& cauchy, const Tensor<Real>& F) {
  return cauchy * cofactor(F);
}

Tensor<Real> isochoric_left_cauchy_green(const Tensor<Real>& F) {
  const Real J = determinant(F);
  return (1 / std::cbrt(J * J)) * (F * transpose(F));
}

template <class Law>
Tensor<Real> hydrostatic(const Law& law, const Tensor<Real>& F) {
  return (static_cast<Real>(law.bulk_modulus()) * (determinant(F) - 1)) * identity<Real>();
}

// First Piola-Kirchhoff stresses in F, in textbook form: Cauchy stresses from the invariants of bbar =
// J^(-2/3) F F^T, and Hooke's law for the Green strain.

Tensor<Real> textbook_piola(const StVenantKirchhoff& law, const Tensor<Real>& F) {
  const Tensor<Real> E = Real(0.5) * (transpose(F) * F - identity<Real>());
  const Real mu = law.shear_modulus();
  const Real lambda = static_cast<Real>(law.bulk_modulus()) - 2 * mu / 3;
  return F * ((lambda * trace(E)) * identity<Real>() + (2 * mu) * E);
}

Tensor<Real> textbook_piola(const CompressibleNeoHookean& law, const Tensor<Real>& F) {
  const Real J = determinant(F), mu = law.shear_modulus();
  const Real lambda = static_cast<Real>(law.bulk_modulus()) - 2 * mu / 3;
  return mu * F + ((lambda * std::log(J) - mu) / J) * cofactor(F);
}

Tensor<Real> textbook_piola(const MooneyRivlin& law, const Tensor<Real>& F) {
  const Tensor<Real> b = isochoric_left_cauchy_green(F);
  const Real c10 = law.c10, c01 = law.c01;
  const Tensor<Real> s = exact_deviator((2 * (c10 + c01 * trace(b))) * b - (2 * c01) * (b * b));
  return piola_of((1 / determinant(F)) * s + hydrostatic(law, F), F);
}

Tensor<Real> textbook_piola(const Yeoh& law, const Tensor<Real>& F) {
  const Tensor<Real> b = isochoric_left_cauchy_green(F);
  const Real x = trace(b) - 3;
  const Real slope = law.c1 + 2 * static_cast<Real>(law.c2) * x + 3 * static_cast<Real>(law.c3) * x * x;
  return piola_of((2 * slope / determinant(F)) * exact_deviator(b) + hydrostatic(law, F), F);
}

/// The undeformed fibre or sheet direction i, deformed and scaled by J^(-1/3).
Triple<Real> isochoric_fibre(const Tensor<Real>& F, int i) {
  const Real r = 1 / std::cbrt(determinant(F));
  return {{r * F(0, i), r * F(1, i), r * F(2, i)}};
}

Tensor<Real> textbook_piola(const FibreNeoHookean& law, const Tensor<Real>& F) {
  const Tensor<Real> b = isochoric_left_cauchy_green(F);
  const Real J = determinant(F);
  const Triple<Real> v = isochoric_fibre(F, 0);
  const Real slope = static_cast<Real>(law.fibre_modulus) / 4 * (double_dot(v, v) - 1);  // dW/dI4bar
  const Tensor<Real> s = static_cast<Real>(law.shear_modulus()) * exact_deviator(b) +
                         (2 * slope) * exact_deviator(v * transpose(v));
  return piola_of((1 / J) * s + hydrostatic(law, F), F);
}

/// From the components of Cbar: S = J^(-2/3) Dev(2 dW/dCbar), Dev(T) = T - (T : C) C^-1 / 3.
Tensor<Real> textbook_piola(const Guccione& law, const Tensor<Real>& F) {
  const Real J = determinant(F), r2 = 1 / std::cbrt(J * J);
  const Tensor<Real> C = transpose(F) * F;
  const Tensor<Real> E = Real(0.5) * (r2 * C - identity<Real>());
  Tensor<Real> T;
  Real Q = 0;
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) {
      const int fibres = (i == 0 ? 1 : 0) + (j == 0 ? 1 : 0);
      const Real exponent = fibres == 2 ? law.along : fibres == 1 ? law.shear : law.across;
      Q += exponent * E(i, j) * E(i, j);
      T(i, j) = exponent * E(i, j);
    }
  }
  const Tensor<Real> S =
      (static_cast<Real>(law.stiffness) * std::exp(Q) * r2) * (T - (double_dot(T, C) / 3) * inverse(C));
  return F * S + piola_of(hydrostatic(law, F), F);
}

/// From invariants: Cauchy stresses of the first, of I4bar_f, I4bar_s and I8bar_fs.
Tensor<Real> textbook_piola(const HolzapfelOgden& law, const Tensor<Real>& F) {
  const Tensor<Real> b = isochoric_left_cauchy_green(F);
  const Triple<Real> f = isochoric_fibre(F, 0), s = isochoric_fibre(F, 1);
  const auto slope = [](Real a, Real exponent, Real x) { return a * x * std::exp(exponent * x * x); };
  const Real stretch_f = double_dot(f, f) - 1, stretch_s = double_dot(s, s) - 1, shear = double_dot(f, s);
  Tensor<Real> tau = static_cast<Real>(law.a) * std::exp(law.b * (trace(b) - 3)) * exact_deviator(b);
  if (stretch_f > 0) tau += (2 * slope(law.a_f, law.b_f, stretch_f)) * exact_deviator(f * transpose(f));
  if (stretch_s > 0) tau += (2 * slope(law.a_s, law.b_s, stretch_s)) * exact_deviator(s * transpose(s));
  tau += slope(law.a_fs, law.b_fs, shear) * exact_deviator(f * transpose(s) + s * transpose(f));
  return piola_of((1 / determinant(F)) * tau + hydrostatic(law, F), F);
}

template <class Law>
class LawOracleTest : public ::testing::Test {};

struct LawName {
  template <class Law>
  static std::string GetName(int /*index*/) {
    std::string name(Law::name);
    std::replace(name.begin(), name.end(), '-', '_');
    return name;
  }
};

using LawsWithTextbooks = ::testing::Types<StVenantKirchhoff, CompressibleNeoHookean, MooneyRivlin, Yeoh,
                                           FibreNeoHookean, Guccione, HolzapfelOgden>;
TYPED_TEST_SUITE(LawOracleTest, LawsWithTextbooks, LawName);

/// In long double the textbook's cancellation costs 1e-19/|H|. Also without the volumetric part, which
/// elements with a pressure of their own leave out.
TYPED_TEST(LawOracleTest, agrees_with_the_textbook_form_in_long_double) {
  RandomGeometry random(13);
  for (const double size : {0.3, 1e-3, 1e-6}) {
    for (int n = 0; n < 100; ++n) {
      const auto law = sample_law<TypeParam>(poisson_ratios[static_cast<std::size_t>(n) % 4]);
      const auto H = random.tensor(size);
      const auto F = identity<Real>() + with_all_digits(H);
      const auto whole = textbook_piola(law, F);
      const auto isochoric = whole - piola_of(hydrostatic(law, F), F);
      const auto difference = [](const Tensor<double>& P, const Tensor<Real>& exact) {
        return largest_entry(with_all_digits(P) - exact);
      };
      const double oracle_error = 1e-18 * (law.bulk_modulus() + law.shear_modulus());
      EXPECT_LT(difference(law.piola(H), whole), 64 * eps * size * law.bulk_modulus() + oracle_error);
      // The isochoric part is as stiff as its bound; without a split, K times |H|^2 remains.
      const double stiffness = tangent_bound(law, H).gradient +
                               (TypeParam::traits.splits_volume ? 0.0 : size * law.bulk_modulus());
      EXPECT_LT(difference(law.isochoric_piola(H), isochoric),
                64 * eps * size * stiffness + 4 * oracle_error);
    }
  }
}

Tensor<double> diagonal_gradient(double a, double b, double c) {
  return {{a - 1, 0, 0, 0, b - 1, 0, 0, 0, c - 1}};
}

/// tau_11 - tau_33 at constant volume: the axial Kirchhoff stress of a bar without lateral stress, at any
/// pressure.
template <class Law>
double axial_stress(const Law& law, double a, double b, double c) {
  const auto P = law.piola(diagonal_gradient(a, b, c));
  return P(0, 0) * a - P(2, 2) * c;
}

template <class Law>
Tensor<double> kirchhoff_in_shear(const Law& law, double gamma) {
  Tensor<double> H{};
  H(0, 1) = gamma;
  return law.piola(H) * transpose(identity<double>() + H);
}

/// Roundoff of stresses that include the bulk modulus: J is 1 up to eps.
template <class Law>
double tolerance(const Law& law, const Tensor<double>& H) {
  const auto bound = tangent_bound(law, H);
  return 64 * eps * (std::abs(bound.volumetric) + bound.gradient);
}

constexpr std::array<double, 5> stretches{0.4, 0.9, 1.01, 1.5, 3.0};
constexpr std::array<double, 4> shears{-1.5, 1e-3, 0.4, 2.0};

/// Uniaxial, equibiaxial and pure shear at constant volume: s P = (s^2 - t^2) 2 (W1 + W2 u^2), where t is the
/// stretch in the stress-free direction and u the third one.
TEST(MooneyRivlin, incompressible_stretches) {
  const MooneyRivlin law{.c10 = 400.0, .c01 = 130.0, .bulk = 1e5};
  EXPECT_EQ(law.shear_modulus(), 1060.0);
  for (const double s : stretches) {
    const double t = 1 / std::sqrt(s);
    EXPECT_NEAR(axial_stress(law, s, t, t), s * 2 * (s - 1 / (s * s)) * (law.c10 + law.c01 / s),
                tolerance(law, diagonal_gradient(s, t, t)));
    EXPECT_NEAR(axial_stress(law, s, s, 1 / (s * s)),
                s * 2 * (s - std::pow(s, -5)) * (law.c10 + law.c01 * s * s),
                tolerance(law, diagonal_gradient(s, s, 1 / (s * s))));
    EXPECT_NEAR(axial_stress(law, s, 1.0, 1 / s), s * 2 * (s - std::pow(s, -3)) * (law.c10 + law.c01),
                tolerance(law, diagonal_gradient(s, 1.0, 1 / s)));
  }
}

/// tau_12 = 2 (c10 + c01) gamma; the second invariant appears in tau_22 - tau_33 = -2 c01 gamma^2.
TEST(MooneyRivlin, simple_shear) {
  const MooneyRivlin law{.c10 = 400.0, .c01 = 130.0, .bulk = 1e4};
  for (const double g : shears) {
    const auto tau = kirchhoff_in_shear(law, g);
    const double roundoff = 64 * eps * law.shear_modulus() * (1 + std::pow(g, 4));
    EXPECT_NEAR(tau(0, 1), 530.0 * 2 * g, roundoff);
    EXPECT_NEAR(tau(0, 0) - tau(2, 2), 800.0 * g * g, roundoff);
    EXPECT_NEAR(tau(1, 1) - tau(2, 2), -260.0 * g * g, roundoff);
  }
}

/// Without the second invariant the law is neo-Hookean.
TEST(MooneyRivlin, contains_the_neo_hookean_law) {
  RandomGeometry random(5);
  const auto neo_hookean = sample_law<NeoHookean>(0.45);
  const MooneyRivlin law{
      .c10 = neo_hookean.shear_modulus() / 2, .c01 = 0.0, .bulk = neo_hookean.bulk_modulus()};
  for (int n = 0; n < 50; ++n) {
    const auto H = random.deformation(0.5, 2.0) - identity<double>();
    EXPECT_LT(largest_entry(law.piola(H) - neo_hookean.piola(H)), tolerance(law, H));
    EXPECT_NEAR(law.energy(H), neo_hookean.energy(H), tolerance(law, H));
  }
}

TEST(Yeoh, incompressible_stretches) {
  const Yeoh law{.c1 = 500.0, .c2 = -40.0, .c3 = 9.0, .bulk = 1e5};
  EXPECT_EQ(law.shear_modulus(), 1000.0);
  const auto slope = [&](double x) { return law.c1 + 2 * law.c2 * x + 3 * law.c3 * x * x; };
  for (const double s : stretches) {
    const double t = 1 / std::sqrt(s);
    EXPECT_NEAR(axial_stress(law, s, t, t), 2 * (s * s - 1 / s) * slope(s * s + 2 / s - 3),
                tolerance(law, diagonal_gradient(s, t, t)));
    EXPECT_NEAR(axial_stress(law, s, s, 1 / (s * s)),
                2 * (s * s - std::pow(s, -4)) * slope(2 * s * s + std::pow(s, -4) - 3),
                tolerance(law, diagonal_gradient(s, s, 1 / (s * s))));
  }
}

TEST(Yeoh, simple_shear) {
  const Yeoh law{.c1 = 500.0, .c2 = -40.0, .c3 = 9.0, .bulk = 1e4};
  for (const double g : shears) {
    Tensor<double> H{};
    H(0, 1) = g;
    const auto tau = kirchhoff_in_shear(law, g);
    const double x = g * g;  // I1bar - 3
    const double mu = 2 * (law.c1 + 2 * law.c2 * x + 3 * law.c3 * x * x);
    EXPECT_NEAR(tau(0, 1), mu * g, tolerance(law, H));
    EXPECT_NEAR(tau(0, 0) - tau(2, 2), mu * g * g, tolerance(law, H));
    EXPECT_NEAR(law.energy(H), x * (law.c1 + x * (law.c2 + x * law.c3)), tolerance(law, H));
  }
}

/// The limit of the parameters: there the shear modulus reaches zero, within it stays positive.
TEST(Yeoh, refuses_parameters_that_lose_the_shear_modulus) {
  EXPECT_FALSE((Yeoh{.c1 = 500.0, .c2 = 10.0, .c3 = 0.0, .bulk = 1e4}.broken_rule()));
  EXPECT_FALSE((Yeoh{.c1 = 500.0, .c2 = -119.0, .c3 = 9.5, .bulk = 1e4}.broken_rule()));
  EXPECT_TRUE((Yeoh{.c1 = 500.0, .c2 = -120.0, .c3 = 9.5, .bulk = 1e4}.broken_rule()));  // 14400 > 14250
  EXPECT_TRUE((Yeoh{.c1 = 500.0, .c2 = -1.0, .c3 = 0.0, .bulk = 1e4}.broken_rule()));
}

TEST(StVenantKirchhoff, uniaxial_strain) {
  for (const double nu : poisson_ratios) {
    const auto law = sample_law<StVenantKirchhoff>(nu);
    const double lambda = lame_lambda(law);
    for (const double s : stretches) {
      const auto H = diagonal_gradient(s, 1.0, 1.0);
      const auto P = law.piola(H);
      EXPECT_NEAR(P(0, 0), (lambda + 2 * law.shear_modulus()) * s * (s * s - 1) / 2, tolerance(law, H));
      EXPECT_NEAR(P(1, 1), lambda * (s * s - 1) / 2, tolerance(law, H));
    }
    // The law loses stiffness at its declared stretch: the tangent of this stress is zero there.
    const auto H = diagonal_gradient(StVenantKirchhoff::traits.softening_stretch, 1.0, 1.0);
    EXPECT_NEAR(slope(law.piola(along(H, unit<3, 3>(0))))(0, 0), 0.0, 1e-14 * p_wave_modulus(law));
  }
}

/// Without lateral stress P = E s (s^2 - 1)/2, and lateral stretches are sqrt(1 - nu (s^2 - 1)).
TEST(StVenantKirchhoff, uniaxial_stress) {
  for (const double nu : poisson_ratios) {
    const auto law = sample_law<StVenantKirchhoff>(nu);
    for (const double s : {0.7, 0.99, 1.1, 1.5}) {
      const double t = std::sqrt(1 - nu * (s * s - 1));
      const auto H = diagonal_gradient(s, t, t);
      const auto P = law.piola(H);
      EXPECT_NEAR(P(0, 0), sample_young_modulus * s * (s * s - 1) / 2, tolerance(law, H));
      EXPECT_NEAR(P(1, 1), 0.0, tolerance(law, H));
      const double green = (s * s - 1) / 2;
      EXPECT_NEAR(law.energy(H), sample_young_modulus * green * green / 2, tolerance(law, H));
    }
  }
}

/// P = mu (s - 1/s) + lambda ln(s) / s along the stretch s, lambda ln(s) across it.
TEST(CompressibleNeoHookean, uniaxial_strain) {
  for (const double nu : poisson_ratios) {
    const auto law = sample_law<CompressibleNeoHookean>(nu);
    const double lambda = lame_lambda(law), mu = law.shear_modulus();
    for (const double s : stretches) {
      const auto H = diagonal_gradient(s, 1.0, 1.0);
      const auto P = law.piola(H);
      EXPECT_NEAR(P(0, 0), mu * (s - 1 / s) + lambda * std::log(s) / s, tolerance(law, H));
      EXPECT_NEAR(P(1, 1), lambda * std::log(s), tolerance(law, H));
    }
  }
}

TEST(StVenantKirchhoff, simple_shear) {
  const auto law = sample_law<StVenantKirchhoff>(0.45);
  const double mu = law.shear_modulus();
  const double lambda = lame_lambda(law);
  for (const double g : shears) {
    Tensor<double> H{};
    H(0, 1) = g;
    const double g2 = g * g;
    const Tensor<double> S{
        {lambda * g2 / 2, mu * g, 0, mu * g, (lambda / 2 + mu) * g2, 0, 0, 0, lambda * g2 / 2}};
    EXPECT_LT(largest_entry(law.piola(H) - (identity<double>() + H) * S), tolerance(law, H));
  }
}

constexpr FibreNeoHookean fibres(double nu = 0.49) {
  return {.young_modulus = 3000.0, .poisson_ratio = nu, .fibre_modulus = 7000.0};
}

/// Along the fibres, k/2 s^2 (s^2 - 1) is added to the neo-Hookean stress; across them, fibres follow the
/// lateral stretch t, and k/2 t^2 (t^2 - 1) is subtracted.
TEST(FibreNeoHookean, incompressible_stretches) {
  const FibreNeoHookean law = fibres();
  for (const double s : stretches) {
    const double t = 1 / std::sqrt(s);
    const double matrix = law.shear_modulus() * (s * s - t * t);
    EXPECT_NEAR(axial_stress(law, s, t, t), matrix + 3500.0 * s * s * (s * s - 1),
                tolerance(law, diagonal_gradient(s, t, t)));
    const auto P = law.piola(diagonal_gradient(t, t, s));  // stretched along the third axis
    EXPECT_NEAR(P(2, 2) * s - P(1, 1) * t, matrix, tolerance(law, diagonal_gradient(t, t, s)));
    EXPECT_NEAR(P(2, 2) * s - P(0, 0) * t, matrix - 3500.0 * t * t * (t * t - 1),
                tolerance(law, diagonal_gradient(t, t, s)));
  }
}

/// Shear along fibres does not stretch them; across, they turn and their squared length grows by gamma^2.
TEST(FibreNeoHookean, simple_shear) {
  const FibreNeoHookean law = fibres();
  for (const double g : shears) {
    Tensor<double> H{};
    H(0, 1) = g;
    EXPECT_NEAR(kirchhoff_in_shear(law, g)(0, 1), law.shear_modulus() * g, tolerance(law, H));
    const Tensor<double> turning = transpose(H);
    const Tensor<double> tau = law.piola(turning) * transpose(identity<double>() + turning);
    EXPECT_NEAR(tau(1, 0), law.shear_modulus() * g + 3500.0 * g * g * g, tolerance(law, H));
  }
}

/// The meaning of k: Young's modulus along the fibres of an incompressible solid is E + k.
TEST(FibreNeoHookean, fibre_modulus_adds_to_youngs_modulus) {
  const auto law = fibres(0.5 - 1e-12);
  const auto stress = small_strain_stress(law, Tensor<double>{{1, 0, 0, 0, -0.5, 0, 0, 0, -0.5}});
  EXPECT_NEAR(stress(0, 0) - stress(1, 1), 10000.0, 1e-7);
}

/// Heart muscle (Land et al. 2015), all exponents nonzero: the bound holds, and shortens the step by at most
/// a factor of sqrt(3), over stretches of .7 to 1.4.
TEST(Guccione, tangent_bound_holds_for_heart_muscle) {
  const Guccione law{.stiffness = 2000.0, .along = 8.0, .across = 2.0, .shear = 4.0, .bulk = 1e5};
  RandomGeometry random(17);
  for (int n = 0; n < 2000; ++n) {
    const auto H = random.deformation(0.7, 1.4) - identity<double>();
    const auto A = current_tangent(law, H);
    const auto symmetric = 0.5 * (A + transpose(A));
    const auto bound = tangent_bound(law, H);
    EXPECT_GT(eigenvalues(slack(bound, symmetric)).front(), -1e-12 * largest_entry(symmetric));
    EXPECT_GT(eigenvalues(symmetric).back(), 0.3 * (std::max(bound.volumetric, 0.0) * 3.0 + bound.gradient));
  }
}

/// Shortened fibres and sheets have no stress: only the matrix and the shear between them remain.
TEST(HolzapfelOgden, shortened_fibres_are_slack) {
  HolzapfelOgden law = sample_law<HolzapfelOgden>(0.45);
  const auto P = law.piola(diagonal_gradient(0.8, 0.9, 1.4));
  law.a_f = law.a_s = 0.0;
  EXPECT_EQ(largest_entry(law.piola(diagonal_gradient(0.8, 0.9, 1.4)) - P), 0.0);
  const auto stretched = diagonal_gradient(1.2, 0.9, 0.9);
  EXPECT_GT(largest_entry(sample_law<HolzapfelOgden>(0.45).piola(stretched) - law.piola(stretched)), 100.0);
}

}  // namespace
}  // namespace sandglass::verification::law_oracle_test
