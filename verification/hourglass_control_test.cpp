/// Hourglass controls that restore the energy that one point misses, against eight points, which include it.

#include <gtest/gtest.h>

#include "problem/model.hpp"
#include "support/patch_mesh.hpp"
#include "support/random_hexahedra.hpp"
#include "support/softening.hpp"
#include "support/tangent.hpp"
#include "support/typed_lists.hpp"

namespace sandglass::verification::hourglass_control_test {
namespace {

constexpr double eps = std::numeric_limits<double>::epsilon();

HourglassModes<double> hourglass_displacements(const NodalVectors<double>& X, const NodalVectors<double>& u) {
  return transpose(hourglass_shape_vectors(X, mean_gradient(X).h)) * u;
}

TEST(SymmetricMatrix, is_the_matrix_that_it_packs) {
  RandomGeometry random(3);
  Matrix<double, 5, 5> a{};
  for (auto& entry : a.entries) entry = random.uniform(-1.0, 1.0);
  const auto packed = symmetric_part(a);
  EXPECT_EQ(packed.entries.size(), 15U);
  EXPECT_EQ(largest_entry(dense(packed) - 0.5 * (a + transpose(a))), 0.0);
  // The same sums, which the compiler may contract differently.
  EXPECT_LT(largest_entry(packed * a - dense(packed) * a), 16 * std::numeric_limits<double>::epsilon());
  EXPECT_EQ(row_sum_bound(Matrix<double, 2, 2>{{1.0, -2.0, -4.0, 0.5}}), 4.5);
}

/// For any displacements, mean gradient and fluctuation together are the gradients at the Gauss points.
TEST(HourglassFluctuation, completes_the_mean_gradient) {
  RandomGeometry random(11);
  for (int n = 0; n < 200; ++n) {
    const auto X = random.hexahedron();
    const auto u = random.displacements(X, 0.6, 1.6, 0.15);
    const Tensor<double> H = transpose(u) * mean_gradient(X).h;
    const auto q = hourglass_displacements(X, u);
    const auto fluctuation = hourglass_fluctuation(X);
    const auto points = gauss_points();
    for (std::size_t p = 0; p < points.size(); ++p) {
      const PointGradient point = point_gradient(X, points[p]);
      const Tensor<double> exact = transpose(u) * point.gradient;
      const Tensor<double> sum = H + transpose(q) * fluctuation.gradient[p];
      // Coordinates are rounded to eps; gradients are up to 50 over the size at these elements' corners.
      const double roundoff =
          256 * eps * largest_entry(point.gradient) * (largest_entry(u) + largest_entry(X));
      EXPECT_LT(largest_entry(sum - exact), roundoff);
      // The same six products of three sums of eight, which the compiler may contract differently.
      EXPECT_NEAR(fluctuation.weight[p], point.measure, 256 * eps * std::pow(largest_entry(X), 3));
    }
  }
}

template <class Law>
class ControlWithLawTest : public ::testing::Test {
 protected:
  RandomGeometry random{23};
};

TYPED_TEST_SUITE(ControlWithLawTest, LawTypes, EntryName);

/// One point with the stabilization matrix IS the mean-dilatation element in the undeformed state: the same
/// tangent for any shape. A matrix with the centre's Jacobian, or from q / 8, would fail.
TYPED_TEST(ControlWithLawTest, stabilization_matrix_is_mean_dilatation_when_undeformed) {
  using OnePointForm = NodalForm<FormulationOf<TlStabilizationMatrix, TypeParam>>;
  using EightPointForm = NodalForm<FormulationOf<TlMeanDilatation, TypeParam>>;
  for (int n = 0; n < 100; ++n) {
    const auto X = this->random.hexahedron();
    const auto law = sample_law<TypeParam>(poisson_ratios[index(n) % poisson_ratios.size()]);
    const auto K = tangent_stiffness<OnePointForm>({}, OnePointForm::precompute(X, law, {}), law);
    const auto exact = tangent_stiffness<EightPointForm>({}, EightPointForm::precompute(X, law, {}), law);
    EXPECT_LT(largest_entry(K - exact), 256 * eps * largest_entry(exact)) << "sample " << n;
  }
}

/// On a distorted mesh, forces of displacements of relative size e differ by a fraction of order e.
TYPED_TEST(ControlWithLawTest, stabilization_matrix_is_mean_dilatation_to_first_order_on_a_mesh) {
  if constexpr (slackens<TypeParam>) GTEST_SKIP() << "shortened fibres are slack: no first order";
  const auto law = sample_law<TypeParam>(0.49);
  const Scene scene = patch_scene(law, Tensor<double>{}, macneal_harder_patch());
  const Model one_point(scene, {std::string(TlStabilizationMatrix::name), {}});
  const Model eight_points(scene, {std::string(TlMeanDilatation::name), {}});
  NodalField direction(scene.mesh.points.size());
  for (auto& v : direction) {
    for (auto& component : v) component = this->random.uniform(-1.0, 1.0);
  }
  const auto relative_difference = [&](double size) {
    NodalField u = direction;
    for (auto& v : u) {
      for (auto& component : v) component *= size;
    }
    const NodalField exact = internal_forces(eight_points, u);
    const NodalField zero(exact.size());
    return largest_distance(internal_forces(one_point, u), exact) / largest_distance(exact, zero);
  };
  // The patch's elements are a quarter of its size, so strains are about ten times e, and the second-order
  // term of a law at nu = .49 contains further factors of ten.
  for (const double size : {1e-4, 1e-6}) EXPECT_LT(relative_difference(size), 100 * size);
}

/// Energy sampling restores 10/9 of the part of (mu/2) F : F that one point misses, on any shape.
TYPED_TEST(ControlWithLawTest, energy_sampling_restores_the_missing_energy) {
  for (int n = 0; n < 100; ++n) {
    const auto X = this->random.hexahedron();
    const auto u = this->random.displacements(X, 0.6, 1.6, 0.15);
    const auto law = sample_law<TypeParam>(0.49);
    const MeanGradient mean = mean_gradient(X);
    const Tensor<double> H = transpose(u) * mean.h;
    double missing = -mean.volume * double_dot(H, H);
    double all = 0.0;
    for (const auto& xi : gauss_points()) {
      const PointGradient point = point_gradient(X, xi);
      const Tensor<double> gradient = transpose(u) * point.gradient;
      all += point.measure * double_dot(gradient, gradient);
    }
    missing += all;
    const double exact = 10.0 / 9.0 * law.shear_modulus() / 2.0 * missing;
    const double energy = hourglass_energy<EnergySamplingControl>(
        hourglass_displacements(X, u), EnergySamplingControl::precompute(X, law, {}));
    // A difference of two sums; gradients lose digits if coordinates are far from the origin.
    EXPECT_NEAR(energy, exact, 1e-11 * law.shear_modulus() * all);
  }
}

/// S of a cube of edge a: the squared gradient of xi eta has the integral (4/a^2)(a^3/3) twice, that of xi
/// eta zeta (4/a^2)(a^3/9) three times, and q / 8 is the amplitude.
TYPED_TEST(ControlWithLawTest, energy_sampling_of_a_cube_in_closed_form) {
  const double a = 0.04;
  const auto law = sample_law<TypeParam>(0.45);
  const auto S = EnergySamplingControl::precompute((0.5 * a) * corner_signs, law, {}).S;
  const double unit = 10.0 / 9.0 * law.shear_modulus() * a / 64.0;
  for (int m = 0; m < 4; ++m) {
    for (int n = 0; n < 4; ++n) {
      const double exact = m != n ? 0.0 : unit * (m == 3 ? 4.0 / 3.0 : 8.0 / 3.0);
      EXPECT_NEAR(S(m, n), exact, 64 * eps * unit);
    }
  }
}

/// phi is defined as the mean over all directions of the second variation of the isochoric neo-Hookean energy
/// along F gamma, over its undeformed value, 10 mu for the nine units of gamma.
TEST(FollowingControl, grows_as_the_mean_second_variation_of_the_isochoric_energy) {
  using DD = Dual<Dual<double>>;
  const NeoHookean law{.young_modulus = 3000.0, .poisson_ratio = 0.49};
  RandomGeometry random(31);
  for (int n = 0; n < 50; ++n) {
    const Tensor<double> F = random.deformation(0.5, 2.0);
    const Tensor<double> H = F - identity<double>();
    double sum = 0.0;
    for (std::size_t k = 0; k < 9; ++k) {
      const Tensor<double> g = F * unit<3, 3>(k);
      Tensor<DD> along_g;
      for (std::size_t m = 0; m < 9; ++m) {
        along_g.entries[m] = DD(Dual<double>(H.entries[m], g.entries[m]), Dual<double>(g.entries[m], 0.0));
      }
      sum += law.isochoric_energy(along_g).slope.slope;
    }
    const double phi = followed_deformation<EnergySamplingControl>(H, volume_change(H)).phi;
    EXPECT_NEAR(sum / (10.0 * law.shear_modulus()), phi, 1e-12 * phi);
  }
}

/// If the twelve amplitudes turn and stretch with the body, their energy in a following control changes only
/// by phi: E(F q, F) = phi E0(q).
TEST(FollowingControl, sees_fluctuations_in_base_vectors_that_move_with_the_body) {
  RandomGeometry random(37);
  for (int n = 0; n < 50; ++n) {
    const Tensor<double> F = random.deformation(0.5, 2.0);
    HourglassModes<double> q{};
    for (auto& entry : q.entries) entry = random.uniform(-1.0, 1.0);
    const Tensor<double> H = F - identity<double>();
    const auto followed = followed_deformation<EnergySamplingControl>(H, volume_change(H));
    EXPECT_LT(largest_entry(convected(q * transpose(F), followed) - q), 64 * eps * 4.0);  // stretches to 2/.5
    const Tensor<double> R = random.rotation() - identity<double>();
    EXPECT_NEAR(followed_deformation<EnergySamplingControl>(R, volume_change(R)).phi, 1.0, 16 * eps);
  }
}

}  // namespace
}  // namespace sandglass::verification::hourglass_control_test
