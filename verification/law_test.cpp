/// Every law on its own, without a mesh.

#include <gtest/gtest.h>

#include "material/laws.hpp"
#include "material/small_strain.hpp"
#include "support/current_tangent.hpp"
#include "support/dense_matrix.hpp"
#include "support/derivatives.hpp"
#include "support/random_hexahedra.hpp"
#include "support/sample_law.hpp"
#include "support/softening.hpp"
#include "support/typed_lists.hpp"

namespace sandglass::verification::law_test {
namespace {

constexpr double eps = std::numeric_limits<double>::epsilon();

/// The stress of linear elasticity.
template <class Law>
Tensor<double> linear_stress(const Law& law, const Tensor<double>& H) {
  return small_strain_stress(law, 0.5 * (H + transpose(H)));
}

template <class Law>
class LawTest : public ::testing::Test {
 protected:
  static constexpr int samples = 200;

  Law law(int n) const {
    return sample_law<Law>(poisson_ratios[static_cast<std::size_t>(n) % poisson_ratios.size()]);
  }
  Tensor<double> large_gradient() { return random.deformation(0.4, 2.0) - identity<double>(); }

  /// Roundoff of a stress: the law's stiffness times that of F, with a factor for stretches to the fifth.
  double tolerance(const Law& of, const Tensor<double>& H) const {
    const auto bound = tangent_bound(of, H);
    return 1024 * eps * (std::abs(bound.volumetric) + bound.gradient);
  }

  RandomGeometry random{11};
};

TYPED_TEST_SUITE(LawTest, LawTypes, EntryName);

TYPED_TEST(LawTest, rest_has_no_energy_and_no_stress) {
  const auto law = this->law(0);
  EXPECT_EQ(law.energy(Tensor<double>{}), 0.0);
  EXPECT_EQ(largest_entry(law.piola(Tensor<double>{})), 0.0);
  EXPECT_EQ(law.pressure(0.0), 0.0);
  EXPECT_EQ(law.volumetric_energy(0.0), 0.0);
}

TYPED_TEST(LawTest, stress_is_the_derivative_of_the_energy) {
  for (int n = 0; n < this->samples; ++n) {
    const auto law = this->law(n);
    const auto H = this->large_gradient();
    const auto dW = gradient(H, [&](const auto& dual_H) { return law.energy(dual_H); });
    EXPECT_LT(largest_entry(dW - law.piola(H)), this->tolerance(law, H));
    const auto dW_isochoric = gradient(H, [&](const auto& dual_H) { return law.isochoric_energy(dual_H); });
    EXPECT_LT(largest_entry(dW_isochoric - law.isochoric_piola(H)), this->tolerance(law, H));
  }
}

TYPED_TEST(LawTest, volumetric_parts_are_derivatives_of_each_other) {
  for (const double J_minus_one : {-0.6, -0.1, 0.0, 0.2, 1.5}) {
    const auto law = this->law(2);
    const D x(J_minus_one, 1.0);
    EXPECT_NEAR(law.volumetric_energy(x).slope, law.pressure(J_minus_one), 16 * eps * law.bulk_modulus());
    EXPECT_NEAR(law.pressure(x).slope, law.bulk_tangent(J_minus_one), 16 * eps * law.bulk_modulus());
  }
}

TYPED_TEST(LawTest, energy_splits_into_isochoric_and_volumetric) {
  for (int n = 0; n < this->samples; ++n) {
    const auto law = this->law(n);
    const auto H = this->large_gradient();
    const double J_minus_one = jacobian_minus_one(H);
    const double sum = law.isochoric_energy(H) + law.volumetric_energy(J_minus_one);
    // The same sum twice, which the compiler may contract differently. Each is within 32 roundings: the terms
    // of the neo-Hookean r have about twenty together, and are up to five times as large as their difference,
    // of which the root leaves a third.
    EXPECT_NEAR(law.energy(H), sum, 64 * eps * sum);
    const auto stress = law.isochoric_piola(H) + law.pressure(J_minus_one) * cofactor(identity<double>() + H);
    EXPECT_LT(largest_entry(law.piola(H) - stress), this->tolerance(law, H));
    // Isochoric energy does not depend on size: F and 1.3 F have the same. Laws that do not split their
    // energy call isochoric the part that is so for infinitesimal strains only.
    if (!TypeParam::traits.splits_volume) continue;
    const auto larger = 1.3 * (identity<double>() + H) - identity<double>();
    EXPECT_NEAR(law.isochoric_energy(larger), law.isochoric_energy(H), this->tolerance(law, H));
  }
}

TYPED_TEST(LawTest, energy_and_stress_do_not_depend_on_the_observer) {
  for (int n = 0; n < this->samples; ++n) {
    const auto law = this->law(n);
    const auto H = this->large_gradient();
    const auto Q = this->random.rotation();
    const auto turned = Q * (identity<double>() + H) - identity<double>();
    EXPECT_NEAR(law.energy(turned), law.energy(H), this->tolerance(law, H));
    EXPECT_LT(largest_entry(law.piola(turned) - Q * law.piola(H)), this->tolerance(law, H));
  }
}

TYPED_TEST(LawTest, energy_does_not_depend_on_the_material_direction) {
  if (!is_isotropic<TypeParam>) GTEST_SKIP() << "the law has directions; they are tested by themselves";
  for (int n = 0; n < this->samples; ++n) {
    const auto law = this->law(n);
    const auto H = this->large_gradient();
    const auto turned = (identity<double>() + H) * this->random.rotation() - identity<double>();
    EXPECT_NEAR(law.energy(turned), law.energy(H), this->tolerance(law, H));
  }
}

TYPED_TEST(LawTest, undeformed_tangent_is_linear_elasticity) {
  for (int n = 0; n < 4; ++n) {
    const auto law = this->law(n);
    for (std::size_t k = 0; k < 9; ++k) {
      const auto direction = unit<3, 3>(k);
      const auto tangent = slope(law.piola(along(Tensor<double>{}, direction)));
      EXPECT_LT(largest_entry(tangent - linear_stress(law, direction)), 16 * eps * law.bulk_modulus());
    }
  }
}

/// At small strain the law is linear elasticity up to O(|H|). Written in F, the energy at |H| = 1e-6 would
/// have an error of eps/|H|^2 = 2e-4, the stress at |H| = 1e-9 one of 2e-7; both would fail here.
TYPED_TEST(LawTest, nothing_cancels_at_small_strains) {
  for (const double size : {1e-4, 1e-6, 1e-9}) {
    for (int n = 0; n < this->samples; ++n) {
      const auto law = this->law(n);
      const auto H = taut<TypeParam>([&] { return this->random.tensor(size); });
      const auto exact = linear_stress(law, H);
      // Second-order terms: a few |H|^2, each with at most the bulk modulus; the smallest samples lose digits
      // in the sum of the strain itself, hence eps.
      const double tolerance = (20.0 * size + 16 * eps) * size * (law.bulk_modulus() + law.shear_modulus());
      EXPECT_LT(largest_entry(law.piola(H) - exact), tolerance);
      EXPECT_NEAR(law.energy(H), 0.5 * double_dot(exact, H), tolerance * size * 9.0);
    }
    // The same without volume change, so that the bulk modulus hides no error.
    for (int n = 0; n < this->samples; ++n) {
      const auto law = this->law(n);
      const auto H = taut<TypeParam>([&] { return deviator(this->random.tensor(size)); });
      const double energy = law.isochoric_energy(H);
      const double exact = 0.5 * double_dot(linear_stress(law, H), H);
      EXPECT_NEAR(energy / exact, 1.0, 40.0 * size + 64 * eps);
    }
  }
}

/// A tiny rotation causes only a strain of the size of its square's roundoff: |H| eps, not eps.
TYPED_TEST(LawTest, tiny_rotation_gives_tiny_stress) {
  const auto law = this->law(0);
  for (const double angle : {1e-3, 1e-6, 1e-9}) {
    Tensor<double> H{};
    H(0, 0) = H(1, 1) = -2.0 * std::sin(angle / 2) * std::sin(angle / 2);
    H(1, 0) = std::sin(angle);
    H(0, 1) = -H(1, 0);
    const double stiffness = 3.0 * law.bulk_modulus() + 2.0 * law.shear_modulus();
    EXPECT_LT(largest_entry(law.piola(H)), 4 * eps * angle * angle * stiffness);
  }
}

/// Single precision keeps its digits at small strains: errors of about 2e-7, as against 6e-2 for formulas in
/// F.
TYPED_TEST(LawTest, single_precision_is_accurate_near_rest) {
  for (const double size : {0.3, 1e-2, 1e-4, 1e-6}) {
    for (int n = 0; n < this->samples; ++n) {
      const auto law = this->law(n);
      const auto H = from_double<float>(this->random.tensor(size));
      Tensor<double> same{};
      for (std::size_t k = 0; k < 9; ++k) same.entries[k] = static_cast<double>(H.entries[k]);
      const auto exact = law.piola(same);
      Tensor<double> difference{};
      const auto P = law.piola(H);
      for (std::size_t k = 0; k < 9; ++k) {
        difference.entries[k] = static_cast<double>(P.entries[k]) - exact.entries[k];
      }
      // Eight roundings of 6e-8; if tr H nearly cancels, the roundings of the bulk part remain.
      const double unit = std::max(largest_entry(exact), size * law.bulk_modulus());
      EXPECT_LT(largest_entry(difference), 1e-6 * unit) << "size " << size;
      const auto deviatoric = law.isochoric_piola(H);
      const auto deviatoric_exact = law.isochoric_piola(same);
      for (std::size_t k = 0; k < 9; ++k) {
        difference.entries[k] = static_cast<double>(deviatoric.entries[k]) - deviatoric_exact.entries[k];
      }
      EXPECT_LT(largest_entry(difference), 2e-6 * largest_entry(deviatoric_exact)) << "size " << size;
    }
  }
}

TYPED_TEST(LawTest, tangent_bound_is_sharp_when_undeformed) {
  for (int n = 0; n < 4; ++n) {
    const auto law = this->law(n);
    const auto bound = tangent_bound(law, Tensor<double>{});
    const double tolerance = 64 * eps * (law.bulk_modulus() + bound.gradient);
    if (is_isotropic<TypeParam>) {
      EXPECT_NEAR(bound.volumetric, lame_lambda(law), tolerance);
      EXPECT_NEAR(bound.gradient, 2.0 * law.shear_modulus(), tolerance);
    }
    // For any law, the bound has no slack under a change of size and none under the stiffest change of shape,
    // which determines both of its numbers. A large penalty removes the change of size from the second.
    auto left = slack(bound, current_tangent(law, Tensor<double>{}));
    double under_change_of_size = 0.0;
    for (int i = 0; i < 9; i += 4) {
      for (int j = 0; j < 9; j += 4) {
        under_change_of_size += left(i, j);
        left(i, j) += law.bulk_modulus();
      }
    }
    EXPECT_NEAR(under_change_of_size, 0.0, 9 * tolerance);
    EXPECT_NEAR(eigenvalues(left).front(), 0.0, tolerance);
  }
}

/// For all L together: no eigenvalue of bound - tangent is negative, from strong compression (0.3) to strong
/// stretch (3).
TYPED_TEST(LawTest, tangent_bound_holds) {
  constexpr double stiff = smallest_stiff_stretch<TypeParam>(0.3);
  double loosest = 1.0;
  for (int n = 0; n < 4000; ++n) {
    const auto law = this->law(n);
    const double smallest = n % 8 < 4 ? 0.3 : stiff;  // four Poisson's ratios each
    const auto H = this->random.deformation(smallest, 3.0) - identity<double>();
    const auto A = current_tangent(law, H);
    const auto bound = tangent_bound(law, H);
    const auto symmetric = 0.5 * (A + transpose(A));
    EXPECT_LT(largest_entry(A - transpose(A)), 1e-11 * largest_entry(A));  // a tangent has a potential
    const double scale = largest_entry(symmetric);
    ASSERT_GT(eigenvalues(slack(bound, symmetric)).front(), -1e-12 * scale);
    // The share of the step that remains: the true largest quadratic form over 3 volumetric + gradient.
    const double top = std::max(bound.volumetric, 0.0) * 3.0 + bound.gradient;
    ASSERT_GT(top, 0.0);  // the step is finite
    if (smallest == stiff) loosest = std::min(loosest, eigenvalues(symmetric).back() / top);
  }
  this->RecordProperty("smallest_true_over_bound", std::to_string(loosest));
  EXPECT_GT(loosest, 0.3);  // the law's bound may shorten the step by at most sqrt(3) anywhere in this range
}

/// Elements may replace the volumetric part by their own; bounds of the isochoric part must hold without it,
/// and with any other.
TYPED_TEST(LawTest, isochoric_tangent_bound_holds) {
  for (int n = 0; n < 1000; ++n) {
    const auto law = this->law(n);
    const auto H = this->random.deformation(0.3, 3.0) - identity<double>();
    const Tensor<double> F = identity<double>() + H;
    const double J_minus_one = jacobian_minus_one(H);
    const double p = this->random.uniform(-1.0, 1.0) * law.bulk_modulus();
    const double bulk = this->random.uniform(0.0, 2.0) * law.bulk_modulus();
    Matrix<double, 9, 9> isochoric{};
    Matrix<double, 9, 9> replaced{};
    for (int k = 0; k < 9; ++k) {
      const auto dual = along(H, unit<3, 3>(static_cast<std::size_t>(k)) * F);
      const auto change = volume_change(dual);
      const D pressure(p, bulk * change.J_minus_one.slope);
      const auto column = slope(law.isochoric_piola(dual)) * transpose(F);
      const auto with_pressure = slope(law.weighted_piola(D(1), dual, change, pressure)) * transpose(F);
      for (int m = 0; m < 9; ++m) {
        isochoric(m, k) = column.entries[static_cast<std::size_t>(m)];
        replaced(m, k) = with_pressure.entries[static_cast<std::size_t>(m)];
      }
    }
    const auto holds = [](const TangentBound<double>& bound, const Matrix<double, 9, 9>& A) {
      const auto symmetric = 0.5 * (A + transpose(A));
      return eigenvalues(slack(bound, symmetric)).front() > -1e-12 * largest_entry(symmetric);
    };
    ASSERT_TRUE(holds(law.isochoric_tangent_bound(H), isochoric));
    ASSERT_TRUE(holds(tangent_bound(law, H, J_minus_one, p, bulk), replaced));
  }
}

/// J sigma = P F^T for any pressure, at small and at large strain.
TYPED_TEST(LawTest, kirchhoff_stress_is_that_of_piola) {
  const double V = 0.7;
  for (const double size : {0.3, 1e-3, 1e-6}) {
    for (int n = 0; n < this->samples; ++n) {
      const auto law = this->law(n);
      const auto H = this->random.tensor(size);
      const auto change = volume_change(H);
      const double p = this->random.uniform(-1.0, 1.0) * size * law.shear_modulus();
      const auto expected = law.weighted_piola(V, H, change, p) * transpose(identity<double>() + H);
      const auto difference = law.weighted_kirchhoff(V, H, change, p) - expected;
      // Without the bulk modulus, which could hide errors; laws without a split have it times |H|^2.
      const double unsplit = TypeParam::traits.splits_volume ? 0.0 : size * size * law.bulk_modulus();
      EXPECT_LT(largest_entry(difference), 256 * eps * (size * tangent_bound(law, H).gradient + unsplit));
    }
  }
}

}  // namespace
}  // namespace sandglass::verification::law_test
