/// The diagnosis of a failed run from its displacements.

#include "comparison/finding.hpp"

#include <gtest/gtest.h>

#include "base/error.hpp"
#include "solve/health.hpp"
#include "solve/relaxation.hpp"
#include "support/random_hexahedra.hpp"
#include "support/scenes.hpp"
#include "support/temporary_folder.hpp"

namespace sandglass::verification::finding_test {
namespace {

constexpr double eps = std::numeric_limits<double>::epsilon();

/// A box of cubes whose nodes are numbered with x fastest; (-1)^(i+j+k) is the zigzag of all of them.
class HourglassContentTest : public ::testing::Test {
 protected:
  NodalField zigzag(double amplitude) const {
    NodalField u;
    for (const auto& X : mesh.points) {
      const long sum = std::lround(X[0] / 0.1) + std::lround(X[1] / 0.1) + std::lround(X[2] / 0.1);
      u.push_back({sum % 2 == 0 ? amplitude : -amplitude, 0.0, 0.0});
    }
    return u;
  }

  Mesh mesh = box({0.3, 0.2, 0.4}, {3, 2, 4});
};

TEST_F(HourglassContentTest, zigzag_is_all_hourglass) {
  const auto content = hourglass_content(mesh, zigzag(0.02));
  EXPECT_NEAR(content.hourglass, 0.02, 64 * eps * 0.02);
  EXPECT_NEAR(content.total, 0.02, 64 * eps * 0.02);
}

/// u_x = x y bends: in an element of edge h the mode xi eta has amplitude h^2 / 4, and all others vanish.
TEST_F(HourglassContentTest, bending_has_the_amplitude_of_its_mode) {
  NodalField u;
  for (const auto& X : mesh.points) u.push_back({X[0] * X[1], 0.0, 0.0});
  EXPECT_NEAR(hourglass_content(mesh, u).hourglass, 0.0025, 256 * eps);
}

TEST(HourglassContent, linear_fields_have_none_on_distorted_elements) {
  RandomGeometry random(31);
  for (int n = 0; n < 50; ++n) {
    const auto X = random.hexahedron();
    Mesh mesh;
    mesh.cells = {{0, 1, 2, 3, 4, 5, 6, 7}};
    NodalField u;
    const Tensor<double> H = random.tensor(1.0);
    for (int I = 0; I < 8; ++I) {
      mesh.points.push_back({X(I, 0), X(I, 1), X(I, 2)});
      u.push_back(linear(H, mesh.points.back()));
    }
    const auto content = hourglass_content(mesh, u);
    EXPECT_LT(content.hourglass, 256 * eps * largest_entry(X) * (1 + largest_entry(X)));
    EXPECT_GT(content.total, 0.0);
  }
}

TEST(Outcome, says_that_elements_are_inverted) {
  Relaxation answer;
  answer.steps = 7;
  EXPECT_EQ(outcome(answer, Precision::double_precision), "no equilibrium after 7 evaluations");
  answer.inverted = true;
  EXPECT_EQ(outcome(answer, Precision::double_precision),
            "no equilibrium after 7 evaluations, and elements are inverted");
}

/// A NaN volume is neither positive nor negative; it must not count as healthy.
TEST(Health, not_a_number_is_distinguished_from_inverted_elements) {
  const auto breakdown_of = [](const std::vector<double>& jacobians) -> std::optional<Breakdown> {
    try {
      require_healthy(jacobians, 7);
    } catch (const ComputationError& error) {
      EXPECT_TRUE(contains(error.what(), "step 7: 1 of 3 elements"));
      EXPECT_TRUE(contains(error.what(), "element 1: "));
      return error.breakdown();
    }
    return std::nullopt;
  };
  EXPECT_EQ(breakdown_of({1.0, 1e-300, 2.0}), std::nullopt);
  EXPECT_EQ(breakdown_of({1.0, 0.0, 2.0}), Breakdown::inverted);
  EXPECT_EQ(breakdown_of({1.0, -0.1, 2.0}), Breakdown::inverted);
  EXPECT_EQ(breakdown_of({1.0, std::nan(""), 2.0}), Breakdown::not_finite);
  EXPECT_EQ(breakdown_of({1.0, -INFINITY, 2.0}), Breakdown::not_finite);
  EXPECT_EQ(breakdown_of({1.0, INFINITY, 2.0}), Breakdown::not_finite);
}

TEST(GoodLimit, is_one_percent_or_what_the_golden_is_worth) {
  EXPECT_EQ(good_limit({}), 0.01);
  EXPECT_EQ(good_limit(0.003), 0.01);
  EXPECT_EQ(good_limit(0.08), 0.08);
}

TEST(GoodLimit, is_never_more_than_ten_percent) {
  EXPECT_EQ(good_limit(0.1), 0.1);
  EXPECT_EQ(good_limit(0.35), 0.1);
}

/// A golden 35 % away from the truth, as block-compression has: a run is good up to a distance of 10 % from
/// the golden, not judged from there to 35 % whatever its symptoms, and diagnosed beyond.
TEST(Judge, a_golden_far_from_the_truth_does_not_judge_what_is_nearer_than_the_truth) {
  EXPECT_EQ(judge({0.1, 0.9, 3.0, 1.5}, 0.35), Finding::good);
  EXPECT_EQ(judge({0.101, 0.0, 1.0, 1.0}, 0.35), Finding::not_judged);
  EXPECT_EQ(judge({0.237, 0.0, 1.0, 1.5}, 0.35), Finding::not_judged);
  EXPECT_EQ(judge({0.35, 0.9, 3.0, 1.5}, 0.35), Finding::not_judged);
  EXPECT_EQ(judge({0.36, 0.9, 3.0, 1.5}, 0.35), Finding::hourglassing);
  EXPECT_EQ(judge({0.36, 0.0, 1.0, 1.5}, 0.35), Finding::locking);
  EXPECT_EQ(judge({0.36, 0.0, 1.0, 1.0}, 0.35), Finding::inaccurate);
  EXPECT_EQ(judge({std::nan(""), 0.0, 1.0, 1.0}, 0.35), Finding::inaccurate);
}

TEST(Judge, a_golden_near_the_truth_or_without_one_judges_all) {
  EXPECT_EQ(judge({0.08, 0.9, 3.0, 1.5}, 0.08), Finding::good);
  EXPECT_EQ(judge({0.09, 0.9, 3.0, 1.5}, 0.08), Finding::hourglassing);
  EXPECT_EQ(judge({0.01, 0.9, 3.0, 1.5}, {}), Finding::good);
  EXPECT_EQ(judge({0.02, 0.0, 1.0, 1.5}, {}), Finding::locking);
}

TEST(Diagnose, distinguishes_the_ways_to_be_wrong) {
  const double limit = 0.02;
  EXPECT_EQ(diagnose({0.02, 0.9, 3.0, 1.5}, limit), Finding::good);
  EXPECT_EQ(diagnose({0.03, 0.1, 1.5, 1.5}, limit), Finding::hourglassing);
  EXPECT_EQ(diagnose({0.03, 0.09, 1.2, 1.03}, limit), Finding::locking);     // smooth
  EXPECT_EQ(diagnose({0.03, 0.9, 1.1, 1.03}, limit), Finding::locking);      // rough, but not large
  EXPECT_EQ(diagnose({0.03, 0.09, 1.3, 1.03}, limit), Finding::inaccurate);  // bends more
  EXPECT_EQ(diagnose({0.03, 0.9, 1.4, 1.02}, limit), Finding::inaccurate);
  EXPECT_EQ(diagnose({0.03, 0.1, 1.0, 0.5}, limit), Finding::inaccurate);  // too soft as a whole
  EXPECT_EQ(diagnose({std::nan(""), 0.1, 1.0, 1.0}, limit), Finding::inaccurate);
}

/// A bent cantilever, nearly incompressible and one element thick, compared with mean dilatation: known
/// failures are found, and the paper's method is good.
TEST(Symptoms, show_the_known_failures) {
  Case description = plain_case(NeoHookean{.young_modulus = 3000.0, .poisson_ratio = 0.49});
  const Mesh mesh = box({1.0, 0.2, 0.2}, {10, 2, 2});
  const NodeSets sets{{"foot", nodes_where(mesh.points, [](const Vector& X) { return X[0] == 0.0; })},
                      {"head", nodes_where(mesh.points, [](const Vector& X) { return X[0] > 0.99; })}};
  description.displacements = {{"foot", {}}, {"head", {0.0, 0.0, 0.2}}};
  const Scene scene = make_scene(description, mesh, sets);
  const auto relaxed = [&](const char* method) {
    Observer silent;
    return relax(Model(scene, {method}), silent);
  };
  const Relaxation golden = relaxed("tl-mean-dilatation");
  const auto found = [&](const char* method) {
    const Relaxation answer = relaxed(method);
    const double energy = answer.energies.strain + answer.energies.hourglass;
    return diagnose(symptoms(scene, answer.u, energy, golden.u, 0.2), 0.01);
  };
  EXPECT_EQ(found("tl-mean-dilatation"), Finding::good);
  EXPECT_EQ(found("tl-perturbation"), Finding::good);
  EXPECT_EQ(found("tl-none"), Finding::hourglassing);
  EXPECT_EQ(found("tl-full"), Finding::locking);
}

/// The same cantilever under a force at its head, a tenth of 3 E I / L^2, which moves it by a tenth of its
/// length: under loads a stiffer body moves less and stores less energy, and locking is still found.
TEST(Symptoms, show_locking_under_loads) {
  Case description = plain_case(NeoHookean{.young_modulus = 3000.0, .poisson_ratio = 0.49});
  const Mesh mesh = box({1.0, 0.2, 0.2}, {10, 2, 2});
  const NodeSets sets{{"foot", nodes_where(mesh.points, [](const Vector& X) { return X[0] == 0.0; })},
                      {"head", nodes_where(mesh.points, [](const Vector& X) { return X[0] > 0.99; })}};
  description.displacements = {{"foot", {}}};
  description.forces.of<DeadForce>() = {{"head", {0.0, 0.0, 0.12}, {}}};
  const Scene scene = make_scene(description, mesh, sets);
  const auto relaxed = [&](const char* method) {
    Observer silent;
    return relax(Model(scene, {method}), silent);
  };
  const Relaxation golden = relaxed("tl-mean-dilatation");
  const Relaxation stiff = relaxed("tl-full");
  ASSERT_LT(stiff.energies.strain, golden.energies.strain);
  const double unit = displacement_unit(scene, golden.u);
  const Symptoms found = symptoms(scene, stiff.u, stiff.energies.strain, golden.u, unit);
  EXPECT_NEAR(found.stiffness_ratio * stiff.energies.strain / golden.energies.strain, 1.0, 1e-6);
  EXPECT_EQ(diagnose(found, 0.01), Finding::locking);
}

}  // namespace
}  // namespace sandglass::verification::finding_test
