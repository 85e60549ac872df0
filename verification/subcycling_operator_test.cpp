/// Subcycling of small elements: averaged forces form a symmetric operator within the stable range; its steps
/// and frequencies.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "mesh/refinement.hpp"
#include "mesh/vectors.hpp"
#include "solve/subcycling.hpp"
#include "support/dense_matrix.hpp"
#include "support/scenes.hpp"
#include "support/subcycled.hpp"

namespace sandglass::verification::subcycling_operator_test {
namespace {

using subcycled::bar, subcycled::moving_case, subcycled::Operator, subcycled::operator_of,
    subcycled::refined_at_the_origin, subcycled::scene_on, subcycled::subcycled_case;

std::vector<double> eigenvalues_of(const Operator& found) {
  return symmetric_eigenvalues(found.matrix);
}

/// Frequencies of the motion in steps, 1/s: sin(w dt / 2) = dt sqrt(eigenvalue) / 2.
std::vector<double> frequencies(const Operator& found) {
  std::vector<double> frequencies = eigenvalues_of(found);
  for (double& w : frequencies) w = std::asin(found.step / 2 * std::sqrt(std::max(w, 0.0))) * 2 / found.step;
  return frequencies;
}

/// With two to four small steps, at any position of fine modes: symmetric up to the rounding of sums, not
/// negative up to that of the largest eigenvalue, and below the stability limit 4 / dt^2. Near a resonance,
/// modes of small elements have (1 + 1 / T_p(d)) / 2 < .92 of that limit with a stabilised polynomial, and
/// all of it without.
TEST(Subcycling, averaged_forces_are_of_a_symmetric_operator_in_the_stable_range) {
  const auto check = [](Scene scene, double times) {
    scene.settings.dynamics.subcycles = 1;
    scene.settings.dynamics.time_step = times * operator_of(scene).step;
    scene.settings.dynamics.subcycles = 16;
    const Operator found = operator_of(scene);
    EXPECT_LT(found.asymmetry(), 1e-14) << times;
    const std::vector<double> values = eigenvalues_of(found);
    EXPECT_GT(found.step * found.step * values.front(), -1e-12);
    EXPECT_LT(found.step * found.step * values.back(), 3.7) << found.substeps << " small steps, " << times;
    return found.substeps;
  };
  std::vector<int> counts;
  const RefinedMesh straight = bar(6), corner = refined_at_the_origin({3, 3, 2});
  for (int n = 21; n < 72; ++n) counts.push_back(check(scene_on(straight, moving_case(1)), 0.05 * n));
  EXPECT_EQ(counts.front(), 2);
  EXPECT_EQ(counts.back(), 4);
  EXPECT_TRUE(std::is_sorted(counts.begin(), counts.end()));
  for (const double times : {1.5, 2.5, 3.5}) check(scene_on(corner, moving_case(1)), times);
  // One middle-sized element is stiff and thus small; its neighbours' nodes hang on large elements.
  Scene scene = scene_on(corner, moving_case(1));
  scene.materials.list.push_back({NeoHookean{.young_modulus = 3e5, .poisson_ratio = 0.3}, 1000.0});
  for (const auto& cell : corner.mesh().cells) {
    const Vector centre = mean_at(cell, corner.mesh().points);
    scene.materials.of_element.push_back(distance(centre, {0.0875, 0.0625, 0.0125}) < 1e-6 ? 1 : 0);
  }
  EXPECT_EQ(std::count(scene.materials.of_element.begin(), scene.materials.of_element.end(), 1), 1);
  for (const double times : {1.5, 2.2}) check(scene, times);
}

/// The largest eigenvalue, times dt^2 / 4, of the averaged forces of a large and a small node. The element
/// between them has steps of dt / share; other elements at the small node may give it any frequency for which
/// its small steps are stable.
double largest_square(const Substeps& substeps, double share) {
  constexpr int pairs = 400, frequencies = 1000;
  const double reach = substeps.reach() * substeps.reach(), large = share * share;
  double largest = 0.0;
  for (int m = 1; m <= frequencies; ++m) {
    const double small = reach * m / frequencies;
    double mean = 0.0, u = 1.0, change = 0.0;
    for (std::size_t k = 0; k < static_cast<std::size_t>(substeps.count()); ++k) {
      mean += substeps.weight(k) * u;
      change = substeps.keep(k) * change - substeps.gain(k) * 4.0 * small * u;
      u += change;
    }
    EXPECT_LE(std::abs(u), 1.0 + 1e-12) << substeps.count() << " " << m;
    for (int n = 1; n < pairs; ++n) {
      const double b = static_cast<double>(n) / pairs;
      if (small < (1.0 - b) * large) continue;
      const double coupling = large * std::sqrt(b * (1.0 - b)),
                   held = b * large - coupling * coupling / small;
      const double first = held + coupling * coupling * mean / small, last = small * mean;
      largest = std::max(largest, (first + last) / 2 + std::hypot((first - last) / 2, coupling * mean));
    }
  }
  return largest;
}

/// Nine tenths of the stable step of large elements are stable with any number of small steps; with two,
/// little more is.
TEST(Subcycling, takes_the_largest_share_of_the_large_step_that_is_stable) {
  for (int p = 2; p <= 64; ++p) EXPECT_LT(largest_square(Substeps(p), Substeps::share_of_large), 1.0) << p;
  EXPECT_GT(largest_square(Substeps(2), Substeps::share_of_large + 0.01), 1.0);
}

/// The bar's cubes allow nine tenths of their step; its smallest elements, which allow a quarter of that,
/// need four small steps: three would suffice for .71 of it.
TEST(Subcycling, chooses_the_step_of_large_elements) {
  const Operator large =
      operator_of(scene_on(RefinedMesh(box({0.05, 0.05, 0.05}, {1, 1, 1})), moving_case(1)));
  const Operator found = operator_of(scene_on(bar(200), moving_case(16)));
  EXPECT_EQ(found.substeps, 4);
  EXPECT_NEAR(found.step, 0.9 * large.step, 1e-12 * large.step);
}

/// The first fourteen frequencies other than rigid motions, to the required .1 %; a step that resolves the
/// last of them has an error of (w dt)^2 / 24 = 2e-4 itself.
TEST(Subcycling, keeps_the_first_frequencies) {
  const RefinedMesh refined = bar(32);
  const std::vector<double> exact = frequencies(operator_of(scene_on(refined, moving_case(1))));
  const std::vector<double> found =
      frequencies(operator_of(scene_on(refined, subcycled_case(refined, 3.59))));
  for (std::size_t k = 6; k < 20; ++k) EXPECT_NEAR(found[k], exact[k], 1e-3 * exact[k]) << k;
}

}  // namespace
}  // namespace sandglass::verification::subcycling_operator_test
