/// How much stiffer laws become, against their energy.

#include "material/stiffening.hpp"

#include <gtest/gtest.h>

#include "support/random_hexahedra.hpp"
#include "support/sample_law.hpp"
#include "support/typed_lists.hpp"

namespace sandglass::verification::stiffening_test {
namespace {

template <class Law>
class StiffeningTest : public ::testing::Test {};

TYPED_TEST_SUITE(StiffeningTest, LawTypes, EntryName);

/// A third of the mean second derivative of the isochoric energy over 2 mu, here by differences of the energy
/// along changes of shape in a rotated frame, on which a trace does not depend. Differences of stress and of
/// energy have errors of about 1e-5 of their sums.
TYPED_TEST(StiffeningTest, is_the_mean_curvature_of_the_energy) {
  if (!TypeParam::traits.splits_volume) return;
  const double s = std::sqrt(0.5), t = std::sqrt(1.0 / 6.0), step = 1e-4;
  const std::vector<Tensor<double>> changes{{{s, 0, 0, 0, -s, 0, 0, 0, 0}},
                                            {{t, 0, 0, 0, t, 0, 0, 0, -2 * t}},
                                            {{0, s, 0, s, 0, 0, 0, 0, 0}},
                                            {{0, 0, s, 0, 0, 0, s, 0, 0}},
                                            {{0, 0, 0, 0, 0, s, 0, s, 0}}};
  RandomGeometry random{11};
  for (int n = 0; n < 200; ++n) {
    const auto law =
        sample_law<TypeParam>(poisson_ratios[static_cast<std::size_t>(n) % poisson_ratios.size()]);
    const CalledLaw called(law);
    EXPECT_EQ(stiffening(called, Tensor<double>{}, nullptr), 1.0);
    const auto H = random.deformation(0.4, 2.0) - identity<double>(), F = identity<double>() + H;
    const Tensor<double> R = random.rotation();
    double sum = 0.0;
    for (const auto& change : changes) {
      const Tensor<double> DF = R * change * transpose(R) * F;
      sum += (law.isochoric_energy(H + step * DF) + law.isochoric_energy(H - step * DF) -
              2.0 * law.isochoric_energy(H)) /
             (step * step);
    }
    const double expected = std::max(1.0, sum / 30.0 / law.shear_modulus());
    EXPECT_NEAR(stiffening(called, H, nullptr), expected, 1e-4 * expected) << n;
  }
}

}  // namespace
}  // namespace sandglass::verification::stiffening_test
