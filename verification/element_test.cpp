/// The geometry of the hexahedron: volume, mean gradients, hourglass vectors.

#include <gtest/gtest.h>

#include "element/hourglass_perturbation.hpp"
#include "mesh/hexahedron.hpp"
#include "support/derivatives.hpp"
#include "support/random_hexahedra.hpp"
#include "support/sample_law.hpp"

namespace sandglass::verification::element_test {
namespace {

constexpr double eps = std::numeric_limits<double>::epsilon();
constexpr int samples = 200;

template <class T>
T triple_product(const NodalVectors<T>& X, int a, int b, int c) {
  return determinant(
      Tensor<T>{{X(a, 0), X(a, 1), X(a, 2), X(b, 0), X(b, 1), X(b, 2), X(c, 0), X(c, 1), X(c, 2)}});
}

/// The volume of the trilinear hexahedron in closed form, without shape functions or quadrature: the volume
/// under a bilinear face is the mean of those under its two triangulations (divergence theorem).
template <class T>
T closed_form_volume(const NodalVectors<T>& X) {
  constexpr int faces[6][4] = {{0, 3, 2, 1}, {4, 5, 6, 7}, {0, 1, 5, 4},
                               {1, 2, 6, 5}, {2, 3, 7, 6}, {3, 0, 4, 7}};
  T sum(0.0);
  for (const auto& [a, b, c, d] : faces) {
    sum = sum + triple_product(X, a, b, c) + triple_product(X, a, c, d);
    sum = sum + triple_product(X, a, b, d) + triple_product(X, b, c, d);
  }
  return sum * T(1.0 / 12.0);
}

/// Coordinates relative to the first node: far from the origin, triple products lose digits by cancellation.
NodalVectors<double> centred(NodalVectors<double> X) {
  for (int I = 7; I >= 0; --I) {
    for (int i = 0; i < 3; ++i) X(I, i) -= X(0, i);
  }
  return X;
}

/// Roundoff of a volume whose coordinates are sheared and up to a few sizes from the origin.
constexpr double volume_tolerance = 1e-12;

TEST(Hexahedron, volume_is_exact) {
  RandomGeometry random(1);
  double centre_error = 0.0;
  for (int n = 0; n < samples; ++n) {
    const auto X = random.hexahedron();
    const double V = closed_form_volume(centred(X));
    EXPECT_NEAR(mean_gradient(X).volume / V, 1.0, volume_tolerance);
    centre_error =
        std::max(centre_error, std::abs(8.0 * determinant(parent_jacobian(X, {0, 0, 0})) / V - 1.0));
  }
  // Samples that distinguish the exact volume from the common 8 det J(0).
  EXPECT_GT(centre_error, 0.01);
}

TEST(Hexahedron, mean_gradients_are_the_derivatives_of_the_volume) {
  RandomGeometry random(2);
  double centre_error = 0.0;
  for (int n = 0; n < samples; ++n) {
    const auto X = random.hexahedron();
    const auto mean = mean_gradient(X);
    const auto B = gradient(centred(X), [](const auto& Y) { return closed_form_volume(Y); });
    EXPECT_LT(largest_entry(mean.volume * mean.h - B), volume_tolerance * largest_entry(B));
    const auto centre = point_gradient(X, {0, 0, 0}).gradient;
    centre_error = std::max(centre_error, largest_entry(centre - mean.h) / largest_entry(mean.h));
  }
  EXPECT_GT(centre_error, 0.01);  // samples that distinguish mean from centre gradients
}

TEST(Hexahedron, mean_gradients_reproduce_constant_and_linear_fields) {
  RandomGeometry random(3);
  for (int n = 0; n < samples; ++n) {
    const auto X = random.hexahedron();
    const auto h = mean_gradient(X).h;
    for (int i = 0; i < 3; ++i) {
      double sum = 0.0;
      for (int I = 0; I < 8; ++I) sum += h(I, i);
      EXPECT_NEAR(sum, 0.0, 64 * eps * largest_entry(h));
    }
    const double scale = 8.0 * largest_entry(X) * largest_entry(h);  // the magnitude of the sums below
    EXPECT_LT(largest_entry(transpose(X) * h - identity<double>()), 16 * eps * scale);
  }
}

TEST(Hexahedron, hourglass_base_vectors_are_orthogonal_signs) {
  constexpr auto Gamma = hourglass_base_vectors();
  for (const double entry : Gamma.entries) EXPECT_EQ(std::abs(entry), 1.0);
  const auto product = transpose(Gamma) * Gamma;
  for (int a = 0; a < 4; ++a) {
    for (int b = 0; b < 4; ++b) EXPECT_EQ(product(a, b), a == b ? 8.0 : 0.0);
  }
  // Orthogonal to the constant and to the parent coordinates: no rigid or uniform part.
  EXPECT_EQ(largest_entry(transpose(Gamma) * corner_signs), 0.0);
  for (int a = 0; a < 4; ++a) {
    double sum = 0.0;
    for (int I = 0; I < 8; ++I) sum += Gamma(I, a);
    EXPECT_EQ(sum, 0.0);
  }
}

TEST(Hexahedron, hourglass_shape_vectors_are_orthogonal_to_linear_fields) {
  RandomGeometry random(4);
  for (int n = 0; n < samples; ++n) {
    const auto X = random.hexahedron();
    const auto h = mean_gradient(X).h;
    const auto gamma = hourglass_shape_vectors(X, h);
    const double scale = 8.0 * largest_entry(X) * largest_entry(h);
    EXPECT_LT(largest_entry(transpose(gamma) * X), 64 * eps * scale * largest_entry(X));
    for (int a = 0; a < 4; ++a) {
      double sum = 0.0;
      for (int I = 0; I < 8; ++I) sum += gamma(I, a);
      EXPECT_NEAR(sum, 0.0, 64 * eps * scale);
    }
    // Zero would be orthogonal too, but gamma has the size of the base vectors.
    EXPECT_GT(largest_entry(gamma), 0.5);
  }
}

TEST(Hexahedron, hourglass_shape_vectors_of_parallelepipeds_are_the_base_vectors) {
  RandomGeometry random(5);
  for (int n = 0; n < samples; ++n) {
    const auto X = random.parallelepiped();
    const auto h = mean_gradient(X).h;
    const auto difference = hourglass_shape_vectors(X, h) - hourglass_base_vectors();
    EXPECT_LT(largest_entry(difference), 512 * eps * largest_entry(X) * largest_entry(h));
  }
}

/// k of the perturbation control for a box a x b x c, by hand: h_Ii = +-1 / (4 a_i), so
/// K_max = V (lambda + 2 mu) (1/a^2 + 1/b^2 + 1/c^2) / 2 (eqs 6-9) and k = kappa K_max / 8 (eqs 10-12).
TEST(PerturbationHourglassControl, stiffness_of_a_box_in_closed_form) {
  const std::array<double, 3> size{0.02, 0.05, 0.03};
  NodalVectors<double> X{};
  for (int I = 0; I < 8; ++I) {
    for (int i = 0; i < 3; ++i) X(I, i) = 0.5 * size[static_cast<std::size_t>(i)] * corner_signs(I, i);
  }
  for_each_type(Laws{}, [&]<class Law>() {
    for (const double nu : poisson_ratios) {
      const Law law = sample_law<Law>(nu);
      const double V = size[0] * size[1] * size[2];
      double sum = 0.0;
      for (const double a : size) sum += 0.5 / (a * a);
      for (const double kappa : {0.0, 0.01, 0.05, 1.0}) {
        const auto element = PerturbationHourglassControl::precompute(X, law, {kappa});
        const double k = kappa * V * p_wave_modulus(law) * sum / 8.0;
        EXPECT_NEAR(element.k, k, 64 * eps * k) << "nu " << nu << " kappa " << kappa;
      }
    }
  });
}

/// Energy of u_x = q xi eta (gamma^T u = 8 q, energy 32 k q^2) on a cube of edge a against beam theory. With
/// xi = 2x/a the strain is 4 q y / a^2, and E/2 times its square over the cube is 2/3 E a q^2: the energy of
/// a cube under pure bending that is free to contract sideways. `auto` gives this energy for all six such
/// modes at every nu.
TEST(PerturbationHourglassControl, auto_bends_a_cube_with_its_exact_energy) {
  const double a = 0.04;
  const double q = 1e-3;
  const NodalVectors<double> X = (0.5 * a) * corner_signs;
  const auto gamma = hourglass_shape_vectors(X, mean_gradient(X).h);
  for_each_type(Laws{}, [&]<class Law>() {
    for (const double nu : poisson_ratios) {
      const Law law = sample_law<Law>(nu);
      const auto element = PerturbationHourglassControl::precompute(X, law, {});
      for (int mode = 0; mode < 3; ++mode) {
        for (int i = 0; i < 3; ++i) {
          if (i == mode) continue;  // u_x = eta zeta is torsion; bending includes the displaced axis
          NodalVectors<double> u{};
          for (int I = 0; I < 8; ++I) u(I, i) = q * hourglass_base_vectors()(I, mode);
          const Matrix<double, 4, 3> amplitudes = transpose(gamma) * u;
          const double energy = PerturbationHourglassControl::energy(amplitudes, element);
          const double exact = 2.0 / 3.0 * young_modulus_of(law) * a * q * q;
          EXPECT_NEAR(energy / exact, 1.0, 1e-12) << "nu " << nu;  // 1 - 2 nu amplifies roundoff
        }
      }
    }
  });
}

/// The tabulated values of the theory, to their digits.
TEST(PerturbationHourglassControl, auto_kappa_has_the_tabulated_values) {
  constexpr std::array<double, 4> tabulated{0.0926, 0.0293, 0.0065, 0.00066};
  constexpr std::array<double, 4> digit{5e-5, 5e-5, 5e-5, 5e-6};
  for (std::size_t n = 0; n < tabulated.size(); ++n) {
    const auto law = sample_law<NeoHookean>(poisson_ratios[n]);
    EXPECT_NEAR(PerturbationHourglassControl::auto_kappa(law), tabulated[n], digit[n]);
  }
}

/// Relative to mu the best kappa is 2 (1 + nu) / 9, nearly constant, and the stiffness is the same.
TEST(PerturbationHourglassControl, auto_gives_the_same_stiffness_on_either_modulus) {
  const NodalVectors<double> X = 0.02 * corner_signs;
  for (const double nu : poisson_ratios) {
    const auto law = sample_law<NeoHookean>(nu);
    const double kappa = PerturbationHourglassControl::auto_kappa(law, KappaModulus::shear);
    EXPECT_NEAR(kappa, 2.0 * (1.0 + nu) / 9.0, 1e-12);  // 1 - 2 nu amplifies roundoff
    const auto stiffness = [&](const HourglassSettings& settings) {
      return PerturbationHourglassControl::precompute(X, law, settings).k;
    };
    EXPECT_NEAR(stiffness({.kappa_modulus = KappaModulus::shear}) / stiffness({}), 1.0, 8 * eps);
    const double ratio = p_wave_modulus(law) / law.shear_modulus();
    EXPECT_NEAR(stiffness({.kappa = 0.02 * ratio, .kappa_modulus = KappaModulus::shear}) / stiffness({0.02}),
                1.0, 8 * eps);
  }
}

}  // namespace
}  // namespace sandglass::verification::element_test
