/// Every method with every law, one element at a time.

#include <gtest/gtest.h>

#include "support/exact_stress.hpp"
#include "support/fitting_elements.hpp"
#include "support/orderings.hpp"
#include "support/sample_law.hpp"
#include "support/tangent.hpp"
#include "support/typed_lists.hpp"

namespace sandglass::verification::formulation_test {
namespace {

constexpr double eps = std::numeric_limits<double>::epsilon();

template <class Pair>
class FormulationTest : public ::testing::Test {
 protected:
  using Kernel = typename Pair::Formulation;
  using Law = typename Pair::Law;

  /// A distorted element with a law that depends on the sample's number.
  struct Sample {
    NodalVectors<double> X{};
    Law law;
    typename Kernel::template Element<double> element;

    NodalVectors<double> force(const NodalVectors<double>& u) const { return Kernel::force(u, element, law); }

    /// Roundoff of a force at u: displacements are rounded by eps times the largest coordinate in the
    /// computation, and the stiffness turns that into force. The factor is for sums of 24 products, twice.
    double tolerance(const NodalVectors<double>& u) const {
      return 256 * eps * Kernel::stiffness_bound(u, element, law) * (largest_entry(u) + largest_entry(X));
    }
  };

  Sample sample(int n) {
    const auto X = fitting_hexahedron<typename Pair::Kernel>(random);
    const Law law = sample_law<Law>(poisson_ratios[static_cast<std::size_t>(n) % poisson_ratios.size()]);
    return {X, law, Kernel::precompute(X, law, {})};
  }

  NodalVectors<double> large_displacements(const NodalVectors<double>& X) {
    return fitting_displacements<typename Pair::Kernel, Law>(random, X, 0.6, 1.6, 0.15);
  }

  static constexpr int samples = 60;
  RandomGeometry random{7};
};

TYPED_TEST_SUITE(FormulationTest, ElasticMethodWithLawTypes, EntryName);

TYPED_TEST(FormulationTest, undeformed_tangent_has_the_right_rank) {
  for (int n = 0; n < this->samples; ++n) {
    const auto s = this->sample(n);
    const auto K =
        tangent_stiffness<typename TypeParam::Formulation>(NodalVectors<double>{}, s.element, s.law);
    const auto values = eigenvalues(K);
    const double largest = values[23];
    int zeros = 0;
    for (const double value : values) {
      zeros += std::abs(value) < 1e-11 * largest ? 1 : 0;  // roundoff of the sums in K
      EXPECT_GT(value, -1e-11 * largest);
    }
    EXPECT_EQ(zeros, zero_energy_modes<typename TypeParam::Method>());
    // The first elastic mode is well above roundoff: softest shear of the flattest sample at nu = .499.
    if (zeros < 24) {
      EXPECT_GT(values[static_cast<std::size_t>(zeros)], 1e-7 * largest);
    }
  }
}

/// For a linear method only infinitesimal rotations are rigid: u = W X with W^T = -W.
TYPED_TEST(FormulationTest, rigid_motion_gives_no_force) {
  for (int n = 0; n < this->samples; ++n) {
    const auto s = this->sample(n);
    Tensor<double> turn = this->random.rotation() - identity<double>();
    if (is_linear<typename TypeParam::Method>) turn = turn - symmetric_part(turn);
    NodalVectors<double> u = s.X * transpose(turn);
    for (int i = 0; i < 3; ++i) {
      const double shift = this->random.uniform(-3, 3) * largest_entry(s.X);
      for (int I = 0; I < 8; ++I) u(I, i) += shift;
    }
    EXPECT_LT(largest_entry(s.force(u)), s.tolerance(u));
    const auto energy = TypeParam::Formulation::energy(u, s.element, s.law);
    EXPECT_LT(std::abs(energy.strain + energy.hourglass), s.tolerance(u) * largest_entry(u));
  }
}

TYPED_TEST(FormulationTest, force_turns_with_the_element) {
  for (int n = 0; n < this->samples; ++n) {
    const auto s = this->sample(n);
    const auto u = this->large_displacements(s.X);
    const auto Q = this->random.rotation();
    const auto turned = (s.X + u) * transpose(Q) - s.X;
    const auto difference = s.force(turned) - s.force(u) * transpose(Q);
    if constexpr (is_linear<typename TypeParam::Method>) {
      // A linear force does not turn: the rotation is one more displacement, whose apparent strain adds V h
      // sigma(sym(Q - I)). Rotations are large here, so the difference is large too.
      const auto mean = mean_gradient(s.X);
      const Tensor<double> stress = exact_stress(true, s.law, Q - identity<double>());
      const auto exact = s.force(u * transpose(Q)) + mean.h * (mean.volume * stress);
      EXPECT_LT(largest_entry(s.force(turned) - exact), 2.0 * s.tolerance(turned));
      EXPECT_GT(largest_entry(difference), 1e3 * s.tolerance(turned));
    } else {
      EXPECT_LT(largest_entry(difference), s.tolerance(u));
    }
  }
}

TYPED_TEST(FormulationTest, force_is_the_derivative_of_the_energy) {
  for (int n = 0; n < this->samples; ++n) {
    const auto s = this->sample(n);
    const auto u = this->large_displacements(s.X);
    const auto dual = dual_element<typename TypeParam::Formulation>(s.element);
    const auto dW = gradient(u, [&](const auto& v) {
      const auto energy = TypeParam::Formulation::energy(v, dual, s.law);
      return energy.strain + energy.hourglass;
    });
    EXPECT_LT(largest_entry(dW - s.force(u)), s.tolerance(u));
  }
}

TYPED_TEST(FormulationTest, tangent_is_symmetric) {
  for (int n = 0; n < this->samples; ++n) {
    const auto s = this->sample(n);
    const auto u = this->large_displacements(s.X);
    const Tangent K = tangent_stiffness<typename TypeParam::Formulation>(u, s.element, s.law);
    EXPECT_LT(largest_entry(K - transpose(K)), 1e-12 * largest_entry(K));
  }
}

/// Moments are about the current positions; in small-strain theory, which does not distinguish the two, about
/// the reference positions.
TYPED_TEST(FormulationTest, forces_balance_momentum_and_angular_momentum) {
  for (int n = 0; n < this->samples; ++n) {
    const auto s = this->sample(n);
    const auto u = this->large_displacements(s.X);
    const auto x = is_linear<typename TypeParam::Method> ? s.X : s.X + u;
    const auto f = s.force(u);
    Matrix<double, 3, 1> momentum{};
    for (int I = 0; I < 8; ++I) {
      for (int i = 0; i < 3; ++i) momentum(i, 0) += f(I, i);
    }
    EXPECT_LT(largest_entry(momentum), s.tolerance(u));
    const Tensor<double> moment = transpose(x) * f;  // symmetric when sum x cross f = 0
    EXPECT_LT(largest_entry(moment - transpose(moment)), 8.0 * s.tolerance(u) * largest_entry(x));
  }
}

/// Under u = H X every consistent element has the stress of H: f = V h P^T, energy V W, ratio det F. On
/// distorted shapes, centre gradients and weights 8 det J(0) fail.
TYPED_TEST(FormulationTest, uniform_strain_gives_the_stress_of_the_law) {
  using Formulation = typename TypeParam::Formulation;
  using Method = typename TypeParam::Method;
  for (int n = 0; n < this->samples; ++n) {
    const auto s = this->sample(n);
    const Tensor<double> H = this->random.deformation(0.6, 1.6) - identity<double>();
    const auto u = s.X * transpose(H);
    const auto mean = mean_gradient(s.X);
    const auto exact = mean.h * (mean.volume * transpose(exact_stress(is_linear<Method>, s.law, H)));
    EXPECT_LT(largest_entry(s.force(u) - exact), s.tolerance(u));
    const auto energy = Formulation::energy(u, s.element, s.law);
    EXPECT_NEAR(energy.strain, mean.volume * exact_energy(is_linear<Method>, s.law, H),
                s.tolerance(u) * largest_entry(u));
    EXPECT_NEAR(energy.hourglass, 0.0, s.tolerance(u) * largest_entry(u));
    const double J = determinant(identity<double>() + H);
    EXPECT_NEAR(Formulation::mean_jacobian(u, s.element), J, 1e-12 * J);
    EXPECT_NEAR(Formulation::smallest_jacobian(u, s.element), J, 1e-12 * J);
  }
}

TYPED_TEST(FormulationTest, node_ordering_does_not_matter) {
  using Formulation = typename TypeParam::Formulation;
  const auto orderings = proper_orderings();
  ASSERT_EQ(orderings.size(), 24U);
  for (int n = 0; n < 12; ++n) {
    const auto s = this->sample(n);
    const auto u = this->large_displacements(s.X);
    const auto f = s.force(u);
    const double W = Formulation::energy(u, s.element, s.law).hourglass;
    for (const auto& ordering : orderings) {
      const auto element = Formulation::precompute(reordered(s.X, ordering), s.law, {});
      const auto g = Formulation::force(reordered(u, ordering), element, s.law);
      EXPECT_LT(largest_entry(g - reordered(f, ordering)), s.tolerance(u));
      const double W_reordered = Formulation::energy(reordered(u, ordering), element, s.law).hourglass;
      EXPECT_NEAR(W_reordered, W, s.tolerance(u) * largest_entry(u));
    }
  }
}

/// Hourglass energy of methods with a kappa is proportional to it, and `auto` is the value that the method
/// declares.
TYPED_TEST(FormulationTest, kappa_scales_the_hourglass_energy) {
  using Formulation = typename TypeParam::Formulation;
  using Method = typename TypeParam::Method;
  if constexpr (Method::Hourglass::traits.takes_kappa) {
    const auto s = this->sample(0);
    const auto u = this->large_displacements(s.X);
    const auto energy = [&](const HourglassSettings& settings) {
      return Formulation::energy(u, Formulation::precompute(s.X, s.law, settings), s.law).hourglass;
    };
    const double unit_energy = energy({1.0});
    EXPECT_GT(unit_energy, 0.0);
    EXPECT_EQ(energy({0.0}), 0.0);
    EXPECT_NEAR(energy({0.037}), 0.037 * unit_energy, 16 * eps * unit_energy);
    EXPECT_NEAR(energy({}), Method::Hourglass::auto_kappa(s.law) * unit_energy, 16 * eps * unit_energy);
  }
}

template <class Law>
class OnePointKernelTest : public ::testing::Test {};

TYPED_TEST_SUITE(OnePointKernelTest, LawTypes, EntryName);

/// Eq. 14 of the paper, assembled from its definitions, with B from the definition of a mean (4^3 Gauss
/// points) and P as the derivative of the law's energy: f = V h P^T + k gamma gamma^T u, k = kappa K_max / 8.
TYPED_TEST(OnePointKernelTest, perturbation_method_is_equation_14) {
  using Formulation = NodalForm<FormulationOf<TlPerturbation, TypeParam>>;
  constexpr std::array<double, 4> points{-0.86113631159405257522, -0.33998104358485626480,
                                         0.33998104358485626480, 0.86113631159405257522};
  constexpr std::array<double, 4> weights{0.34785484513745385737, 0.65214515486254614263,
                                          0.65214515486254614263, 0.34785484513745385737};
  RandomGeometry random(8);
  for (const double kappa : {0.0, 0.005, 0.02, 0.1, 1.0}) {
    for (const double nu : poisson_ratios) {
      const auto X = random.hexahedron();
      const auto u = random.displacements(X, 0.6, 1.6, 0.15);
      const auto law = sample_law<TypeParam>(nu);
      NodalVectors<double> B{};
      double V = 0.0;
      for (std::size_t n = 0; n < 64; ++n) {
        const std::array<std::size_t, 3> at{n % 4, n / 4 % 4, n / 16};
        const auto point = point_gradient(X, {points[at[0]], points[at[1]], points[at[2]]});
        const double w = weights[at[0]] * weights[at[1]] * weights[at[2]] * point.measure;
        B += w * point.gradient;
        V += w;
      }
      const Tensor<double> H = (1.0 / V) * (transpose(u) * B);
      const auto P = gradient(H, [&](const auto& dual_H) { return law.energy(dual_H); });
      const double k = kappa / 8.0 * p_wave_modulus(law) * double_dot(B, B) / V;
      const auto Gamma = hourglass_base_vectors();
      const auto gamma = Gamma - (1.0 / V) * (B * (transpose(X) * Gamma));
      const auto exact = B * transpose(P) + k * (gamma * (transpose(gamma) * u));
      const auto element = Formulation::precompute(X, law, {kappa});
      // As in Sample::tolerance above: roundoff of displacements times stiffness.
      const double tolerance =
          256 * eps * Formulation::stiffness_bound(u, element, law) * (largest_entry(u) + largest_entry(X));
      EXPECT_LT(largest_entry(Formulation::force(u, element, law) - exact), tolerance);
    }
  }
}

}  // namespace
}  // namespace sandglass::verification::formulation_test
