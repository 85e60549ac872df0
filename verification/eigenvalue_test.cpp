/// True eigenvalues of elements and meshes: exact values for uniform strains and bending, and the largest
/// eigenvalue against the bound of the stable step, in elements and meshes of every shape, undeformed and
/// strongly deformed.

#include <gtest/gtest.h>

#include "support/sharpness.hpp"

namespace sandglass::verification::eigenvalue_test {
namespace {

constexpr double eps = std::numeric_limits<double>::epsilon();

template <class Pair>
class EigenvalueTest : public ::testing::Test {
 protected:
  using Tangent = MeshTangent<typename Pair::Kernel, typename Pair::Law>;

  /// K u (N) of one undeformed element with corners at X.
  static NodalVectors<double> force(const Mesh& mesh, const NodalVectors<double>& u,
                                    const typename Pair::Law& law, std::optional<double> kappa = {}) {
    NodalField v(8);
    for (int I = 0; I < 8; ++I) {
      for (int i = 0; i < 3; ++i) v[index(mesh.cells[0][index(I)])][index(i)] = u(I, i);
    }
    const NodalField rest(8);
    const Tangent tangent(mesh, law, {.kappa = kappa}, rest);
    return gather(tangent.along(v), mesh.cells[0]);
  }

  /// A box of the given half edges about the origin.
  static Mesh brick(const std::array<double, 3>& half) {
    Mesh mesh = box({2 * half[0], 2 * half[1], 2 * half[2]}, {1, 1, 1});
    for (auto& X : mesh.points) {
      for (std::size_t i = 0; i < 3; ++i) X[i] -= half[i];
    }
    return mesh;
  }

  /// Energy of a bar along i under pure bending in the plane i, j over the exact energy, E/2 V l_j^2 / 3 for
  /// u_i = x_i x_j (see hourglass_forms_test.cpp). The bar is free to change its width: of u_k = b x_j x_k it
  /// takes the amount with the least energy, which is b = -nu in a real bar. u_j is the same at all corners.
  static double bending_over_exact(const std::array<double, 3>& half, int i, int j, double nu,
                                   std::optional<double> kappa = {}) {
    const Mesh mesh = brick(half);
    const auto law = sample_law<typename Pair::Law>(nu);
    const int k = 3 - i - j;
    NodalVectors<double> along{}, across{};
    const auto X = gather(mesh.points, mesh.cells[0]);
    for (int I = 0; I < 8; ++I) {
      along(I, i) = X(I, i) * X(I, j);
      across(I, k) = X(I, k) * X(I, j);
    }
    const auto f = force(mesh, along, law, kappa);
    const double own = double_dot(along, f), mixed = double_dot(across, f);
    const double free = double_dot(across, force(mesh, across, law, kappa));
    const double V = 8 * half[0] * half[1] * half[2], l = half[index(j)];
    return (own - mixed * mixed / free) / (young_modulus_of(law) * V * l * l / 3);
  }

  /// The same for torsion of a bar along k, u_i = x_j x_k and u_j = -x_i x_k: a shear of x_j and of -x_i
  /// against k, with mu/2 V (l_i^2 + l_j^2) / 3 if sections stay plane.
  static double torsion_over_exact(const std::array<double, 3>& half, int k, double nu) {
    const Mesh mesh = brick(half);
    const auto law = sample_law<typename Pair::Law>(nu);
    const int i = (k + 1) % 3, j = (k + 2) % 3;
    NodalVectors<double> u{};
    const auto X = gather(mesh.points, mesh.cells[0]);
    for (int I = 0; I < 8; ++I) {
      u(I, i) = X(I, j) * X(I, k);
      u(I, j) = -X(I, i) * X(I, k);
    }
    const double V = 8 * half[0] * half[1] * half[2];
    const double sum = half[index(i)] * half[index(i)] + half[index(j)] * half[index(j)];
    const double exact = 0.5 * law.shear_modulus() * V * sum / 3;
    return 0.5 * double_dot(u, force(mesh, u, law)) / exact;
  }

  void record(const std::string& name, double value) { this->RecordProperty(name, std::to_string(value)); }

  void expect_safe(bool single, const Strain& strain, int samples) {
    Distribution found = sharpness<Pair>(random, samples, single, strain);
    EXPECT_EQ(found.unsafe, 0);
    record("true_over_bound_min", found.quantile(0.0));
    record("true_over_bound_median", found.quantile(0.5));
    record("true_over_bound_max", found.quantile(1.0));
  }

  RandomGeometry random{29};
};

using AllPairs = detail::AsTestTypes<PairsOf<Methods>>::type;
TYPED_TEST_SUITE(EigenvalueTest, AllPairs, EntryName);

/// On a cube of edge h, a dilation and every uniform strain without trace are eigenvectors. Stress is 3 K and
/// 2 mu times the strain, f_I = V sigma h_I, and h_I = X_I / (2 h^2): the eigenvalues are 3 K h / 2 and mu h,
/// for every method and every isotropic law.
TYPED_TEST(EigenvalueTest, uniform_strains_of_a_cube_have_their_moduli) {
  using Law = typename TypeParam::Law;
  if (!is_isotropic<Law>) return;
  const double h = 0.02;
  const Mesh cube = this->brick({h / 2, h / 2, h / 2});
  const auto X = gather(cube.points, cube.cells[0]);
  for (const double nu : poisson_ratios) {
    const Law law = sample_law<Law>(nu);
    const double dilation = 1.5 * law.bulk_modulus() * h, shear = law.shear_modulus() * h;
    const double roundoff = 256 * eps * dilation * h;
    EXPECT_LT(largest_entry(this->force(cube, X, law) - dilation * X), roundoff);
    for (int n = 0; n < 5; ++n) {
      const Tensor<double> any = this->random.tensor(0.5);
      const Tensor<double> strain = deviator(any + transpose(any));
      const NodalVectors<double> u = X * strain;
      EXPECT_LT(largest_entry(this->force(cube, u, law) - shear * u), roundoff);
    }
  }
}

/// Perturbation control stands for kappa (lambda + 2 mu) V sum(h^2) / 8 in every hourglass mode. On a box of
/// half edges l, sum(h^2) = sum_n 1 / (8 l_n^2), and the bar along i that bends has, over its exact energy,
///   3 kappa (lambda + 2 mu) / E l_i^2 sum_n 1/l_n^2:
/// 9 kappa (lambda + 2 mu) / E on a cube, exact with the kappa that `auto` takes; (1 + 200)/3 = 67 on a bar
/// of aspect ten. A control that only damps has no such energy.
TYPED_TEST(EigenvalueTest, bending_of_a_box_follows_kappa) {
  using Method = typename TypeParam::Method;
  using Law = typename TypeParam::Law;
  if constexpr (kappa_affects_equilibrium<Method>) {
    if (!is_isotropic<Law>) return;
    const std::array<std::array<double, 3>, 3> boxes{{{0.5, 0.5, 0.5}, {5.0, 0.5, 0.5}, {0.2, 0.7, 0.4}}};
    for (const double nu : poisson_ratios) {
      const Law law = sample_law<Law>(nu);
      const double modulus = p_wave_modulus(law) / young_modulus_of(law);
      const double automatic = Method::Hourglass::auto_kappa(law);
      EXPECT_NEAR(9 * automatic * modulus, 1.0, 1e-12);
      EXPECT_NEAR(this->bending_over_exact(boxes[0], 0, 1, nu), 1.0, 1e-10);
      EXPECT_NEAR(this->bending_over_exact(boxes[1], 0, 1, nu), 67.0, 67e-10);
      for (const auto& half : boxes) {
        double sum = 0.0;
        for (const double l : half) sum += 1.0 / (l * l);
        for (int i = 0; i < 3; ++i) {
          for (const double kappa : {automatic, 0.05}) {
            const double ratio = 3 * kappa * modulus * half[index(i)] * half[index(i)] * sum;
            EXPECT_NEAR(this->bending_over_exact(half, i, (i + 1) % 3, nu, kappa) / ratio, 1.0, 1e-10);
          }
        }
      }
    }
  }
}

/// What every method has of the exact energies of bending and torsion, on a cube and on a bar of aspect ten,
/// as properties. Eight points have the integral of the energy of their displacements: of torsion the exact
/// one; of bending, times 2/V and 3,
///   (lambda + 2 mu) (1 + b^2) l_j^2 + 2 lambda b l_j^2 + mu (l_i^2 + b^2 l_k^2),
/// at the best b, with -2/3 mu for lambda where pressure is averaged; E l_j^2 would be exact.
TYPED_TEST(EigenvalueTest, bending_and_torsion_energies) {
  using Method = typename TypeParam::Method;
  using Law = typename TypeParam::Law;
  if (zero_energy_modes<Method>() > 6 || !is_isotropic<Law>) return;
  for (const double nu : {0.25, 0.49}) {
    const Law law = sample_law<Law>(nu);
    for (const double length : {1.0, 10.0}) {
      const std::array<double, 3> half{length / 2, 0.5, 0.5};
      const double bending = this->bending_over_exact(half, 0, 1, nu);
      const double torsion = this->torsion_over_exact(half, 0, nu);
      const std::string where =
          "_aspect_" + std::to_string(static_cast<int>(length)) + "_nu_" + std::to_string(nu);
      this->record("bending_over_exact" + where, bending);
      this->record("torsion_over_exact" + where, torsion);
      EXPECT_GT(bending, 0.05);
      EXPECT_GT(torsion, 0.05);
      if constexpr (integration_points<Method> == 8) {
        const double mu = law.shear_modulus();
        const double lambda =
            Method::Kinematics::traits.averages_pressure ? -2.0 / 3.0 * mu : lame_lambda(law);
        const double normal = lambda + 2 * mu;  // l_j = l_k = 1/2, l_i = length/2, all over l_j
        const double expected =
            (normal + mu * length * length - lambda * lambda / (normal + mu)) / young_modulus_of(law);
        EXPECT_NEAR(bending / expected, 1.0, 1e-10);
        EXPECT_NEAR(torsion, 1.0, 1e-10);
      }
    }
  }
}

// The bound of the stable step as runs use it. All pairs of methods and laws together test 10,000 elements
// and more than 100 meshes, undeformed and strongly deformed; verification/sharpness.cpp prints the
// distribution of more.

TYPED_TEST(EigenvalueTest, step_is_safe_for_undeformed_elements) {
  this->expect_safe(true, undeformed, 190);
}

TYPED_TEST(EigenvalueTest, step_is_safe_for_strongly_deformed_elements) {
  this->expect_safe(true, strongly_deformed, 190);
}

TYPED_TEST(EigenvalueTest, step_is_safe_for_undeformed_meshes) {
  this->expect_safe(false, undeformed, 2);
}

TYPED_TEST(EigenvalueTest, step_is_safe_for_strongly_deformed_meshes) {
  this->expect_safe(false, strongly_deformed, 2);
}

/// The smallest elements for which a bound without the curvature of current geometry is unsafe: unit cubes
/// bent by patterns of 0.2 of an edge. In the Updated Lagrangian formulation the true eigenvalue was 1.011 of
/// such a bound for u_x = 0.2 eta zeta, 1.084 together with u_z = 0.2 xi eta, nearly incompressible.
TYPED_TEST(EigenvalueTest, step_is_safe_for_bent_cubes) {
  using Law = typename TypeParam::Law;
  const Mesh cube = this->brick({0.5, 0.5, 0.5});
  for (const double nu : poisson_ratios) {
    for (int first = 0; first < 12; ++first) {
      for (int second = 0; second < 12; ++second) {
        Sample sample{cube, NodalField(8)};
        for (int I = 0; I < 8; ++I) {
          Vector& u = sample.u[index(cube.cells[0][index(I)])];
          u[index(first % 3)] += 0.2 * hourglass_base_vectors()(I, first / 3);
          if (second != first) u[index(second % 3)] += 0.2 * hourglass_base_vectors()(I, second / 3);
        }
        const auto law = sample_law<Law>(nu);
        const typename TestFixture::Tangent tangent(cube, law, {}, sample.u);
        if (!(tangent.smallest_jacobian() > 0.1)) continue;
        EXPECT_LE(true_over_bound<TypeParam>(sample, law), 1.0 + 1e-10)
            << "patterns " << first << " and " << second << ", nu " << nu;
      }
    }
  }
}

/// With a user's kappa, hourglass modes may set the step of deformed elements.
TYPED_TEST(EigenvalueTest, step_is_safe_with_a_stiff_hourglass_control) {
  using Law = typename TypeParam::Law;
  if (!TypeParam::Method::Hourglass::traits.takes_kappa) return;
  for (int n = 0; n < 60; ++n) {
    const Sample sample = random_sample<TypeParam>(this->random, {1, 1, 1}, shapes[index(n) % shapes.size()],
                                                   strongly_deformed);
    const auto law = sample_law<Law>(poisson_ratios[index(n) % poisson_ratios.size()]);
    for (const double kappa : {0.3, 3.0}) {
      EXPECT_LE(true_over_bound<TypeParam>(sample, law, kappa), 1.0 + 1e-10) << n << " kappa " << kappa;
    }
  }
}

}  // namespace
}  // namespace sandglass::verification::eigenvalue_test
