/// Small-strain elasticity: right for small rotations and strains, wrong by known amounts for large ones.

#include <gtest/gtest.h>

#include "solve/frame.hpp"
#include "support/derivatives.hpp"
#include "support/distorted_bar.hpp"
#include "support/exact_stress.hpp"
#include "support/typed_lists.hpp"

namespace sandglass::verification::linear_test {
namespace {

constexpr double eps = std::numeric_limits<double>::epsilon();

template <class Law>
class SmallStrainLawTest : public ::testing::Test {};
TYPED_TEST_SUITE(SmallStrainLawTest, LawTypes, EntryName);

/// The stress of a small strain is the derivative of the law's stress in the undeformed state, to which
/// rotation does not contribute: for any H the slope of P along H is the stress of sym(H).
TYPED_TEST(SmallStrainLawTest, stress_is_the_undeformed_tangent) {
  RandomGeometry random(31);
  for (const double nu : poisson_ratios) {
    const auto any = sample_law<TypeParam>(nu);
    for (int n = 0; n < 20; ++n) {
      const Tensor<double> H = random.tensor(1.0);
      const Tensor<double> tangent = slope(any.piola(along(Tensor<double>{}, H)));
      const Tensor<double> stress = small_strain_stress(any, symmetric_part(H));
      // Terms like K - 2/3 mu lose a few digits of a sum of moduli times entries of H.
      EXPECT_LT(largest_entry(stress - tangent), 64 * eps * (any.bulk_modulus() + any.shear_modulus()));
    }
  }
}

const MethodChoice linear_method{"linear"};
const MethodChoice condensed_method{"linear-condensed"};

/// For small strains and rotations, small-strain theory is the first term of the others: its relative error
/// is of first order in the displacements, a tenth for a tenth of the load.
TEST(LinearTest, agrees_with_total_lagrangian_to_first_order_in_strain) {
  const auto relative_difference = [](double share) {
    const Vector d{share * 0.1, share * -0.05, share * 0.08};  // the bar is 0.3 m long
    const Scene scene = distorted_bar(d);
    return largest_distance(relaxed(scene, condensed_method), relaxed(scene, {"tl-perturbation"})) /
           largest_imposed(scene);
  };
  const double large = relative_difference(1e-2), small = relative_difference(1e-3);
  EXPECT_LT(large, 0.01);
  EXPECT_NEAR(large / small, 10.0, 0.5);
  // At full load, with strains of tens of percent, the error is obvious.
  EXPECT_GT(relative_difference(1.0), 0.05);
}

/// A block is tilted by 60 degrees about an edge of its foot: the heights of the foot's nodes are imposed, z
/// = y sin 60 as in a rotation; all else is free. A real body rotates without strain. In small-strain theory
/// the rotation is u = s (-z, y) with s = sin 60: the block grows by sqrt(1 + s^2), by a third in length and
/// three quarters in volume, and no force reveals it.
TEST(LinearTest, a_block_that_turns_by_60_degrees_grows) {
  const double s = std::sin(std::acos(0.5));
  Case description = plain_case(sample_law<NeoHookean>(0.49));
  const Mesh mesh = box({0.1, 0.1, 0.2}, {2, 2, 4});
  NodeSets sets;
  for (const int n : nodes_where(mesh.points, [](const Vector& X) { return X[2] == 0.0; })) {
    const double y = mesh.points[index(n)][1];
    const std::string name = "node " + std::to_string(n);
    sets[name] = {n};
    description.displacements.push_back({name, {0.0, 0.0, s * y}, {true, y == 0.0, true}});
  }
  const Scene scene = make_scene(description, mesh, sets);
  const CondensedResponse<double> response = response_of_sets(scene);
  std::vector<Vector> d, f(response.handles());
  for (const auto& displacement : description.displacements) d.push_back(displacement.value);
  NodalField u(mesh.points.size()), turned, grown;
  response.displacements(d, u);
  response.forces(d, f);
  for (const auto& X : mesh.points) {
    turned.push_back({0.0, -0.5 * X[1] - s * X[2], s * X[1] - 0.5 * X[2]});
    grown.push_back({0.0, -s * X[2], s * X[1]});
  }
  const double stiffness = *std::max_element(response.stiffness().begin(), response.stiffness().end());
  EXPECT_LT(largest_distance(u, grown), 1e-12);
  EXPECT_LT(largest_distance(f, std::vector<Vector>(f.size())), 1e-12 * stiffness);
  const Model linear(scene, linear_method), total(scene, {"tl-perturbation"});
  for (const double J : static_frame(linear, 1.0, u).jacobians) EXPECT_NEAR(J, 1.0 + s * s, 1e-10);
  // With finite strain the same scene's answer is the true rotation, without strain.
  for (const double J : static_frame(total, 1.0, turned).jacobians) EXPECT_NEAR(J, 1.0, 1e-12);
  const NodalField none(mesh.points.size());
  EXPECT_LT(largest_distance(internal_forces(total, turned), none), 1e-12 * stiffness);
  EXPECT_GT(largest_distance(internal_forces(linear, turned), none), 1e-3 * stiffness * 0.1);
}

}  // namespace
}  // namespace sandglass::verification::linear_test
