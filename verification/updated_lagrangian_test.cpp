/// The Updated Lagrangian methods: properties that they share with Total Lagrangian ones, and the allowed
/// difference between the two.

#include <gtest/gtest.h>

#include "assembly/method_entry.hpp"
#include "solve/relaxation.hpp"
#include "support/dense_matrix.hpp"
#include "support/derivatives.hpp"
#include "support/orderings.hpp"
#include "support/patch_mesh.hpp"
#include "support/path.hpp"
#include "support/random_hexahedra.hpp"
#include "support/single_element.hpp"
#include "support/typed_lists.hpp"

namespace sandglass::verification::updated_lagrangian_test {
namespace {

constexpr double eps = std::numeric_limits<double>::epsilon();

const NeoHookean law{.young_modulus = 3000.0, .poisson_ratio = 0.45};

MethodChoice method(std::string_view name, std::optional<double> kappa = {}) {
  return {std::string(name), kappa};
}

double largest_component(const NodalField& field) {
  double largest = 0.0;
  for (const auto& row : field) {
    for (const double x : row) largest = std::max(largest, std::abs(x));
  }
  return largest;
}

NodalField map_points(const Mesh& mesh, const Tensor<double>& F) {
  NodalField u;
  for (const auto& X : mesh.points) u.push_back(linear(F - identity<double>(), X));
  return u;
}

Tensor<double> turn_about_z(double angle) {
  return {{std::cos(angle), -std::sin(angle), 0, std::sin(angle), std::cos(angle), 0, 0, 0, 1}};
}

/// Simultaneous stretch and rotation: F(s) on a path that starts at I.
Tensor<double> on_the_way(double s) {
  const Tensor<double> stretch{{1 + 0.4 * s, 0.2 * s, 0, 0, 1 - 0.2 * s, 0.1 * s, 0, 0, 1 + 0.1 * s}};
  return turn_about_z(1.5 * s) * stretch;
}

NodalField turned(const NodalField& field, const Tensor<double>& R) {
  NodalField result;
  for (const auto& row : field) result.push_back(linear(R, row));
  return result;
}

/// A step (s) short enough for viscous controls to matter: a wave needs about a tenth of a second to cross an
/// element.
constexpr double short_step = 1e-3;

template <class MethodType>
class UpdatedLagrangianTest : public ::testing::Test {
 protected:
  using Kernel = FormulationOf<MethodType, NeoHookean>;
  using UncontrolledKernel = Formulation<UpdatedOnePoint, NoHourglassControl, NeoHookean>;
  using Element = SingleElement<Kernel, NeoHookean>;
  static constexpr bool resists_displacements = zero_energy_modes<MethodType>() == 6;

  static MethodChoice chosen() { return method(MethodType::name); }

  /// Roundoff of a force on an element: as in the tests of single elements, the stiffness, with its viscous
  /// part, times roundoff of displacements.
  static double tolerance(const Element& element, const NodalVectors<double>& X) {
    return 256 * eps * element.stiffness_bound() * 3.0 * largest_entry(X);
  }

  RandomGeometry random{23};
};

TYPED_TEST_SUITE(UpdatedLagrangianTest, UpdatedLagrangianTypes, EntryName);

/// The patch test of a method that integrates: an affine path of a distorted mesh has no hourglass
/// velocities, so that in the end forces are those of the Total Lagrangian element, V h P^T, and vanish at
/// the inner nodes. Roundoff of 400 steps: each adds eps of the coordinates to the resistances.
TYPED_TEST(UpdatedLagrangianTest, affine_path_passes_the_patch_test) {
  const Mesh mesh = macneal_harder_patch();
  Path updated(mesh, law, this->chosen());
  Path total(mesh, law, method("tl-perturbation"));
  constexpr int steps = 400;
  NodalField force;
  for (int n = 1; n <= steps; ++n) {
    force = updated.to(map_points(mesh, on_the_way(static_cast<double>(n) / steps)), short_step);
  }
  const NodalField exact = total.to(map_points(mesh, on_the_way(1.0)));
  const double tolerance = 64 * eps * steps * law.bulk_modulus();
  EXPECT_LT(largest_distance(force, exact), tolerance);
  for (int n = 0; n < first_corner; ++n) {
    for (const double f : force[index(n)]) EXPECT_NEAR(f, 0.0, tolerance);
  }
}

TYPED_TEST(UpdatedLagrangianTest, rigid_rotation_gives_no_force) {
  const Mesh mesh = macneal_harder_patch();
  Path updated(mesh, law, this->chosen());
  constexpr int steps = 400;
  for (int n = 1; n <= steps; ++n) {
    const NodalField force = updated.to(map_points(mesh, turn_about_z(6.3 * n / steps)), short_step);
    EXPECT_LT(largest_component(force), 64 * eps * n * law.bulk_modulus());
  }
}

/// A bent element that turns by 90 degrees keeps its forces, which turn with it. The spin of one step is
/// evaluated at its end, sin(angle) for angle: the turn is short by angle^3/4 per step, so by the square of
/// the step in total. Methods without memory must be exact: the turn of a bent element is affine too.
TYPED_TEST(UpdatedLagrangianTest, resistances_turn_with_the_element) {
  const Mesh mesh = box({1, 1, 1}, {1, 1, 1});
  NodalField bent;
  for (std::size_t n = 0; n < 8; ++n) {
    bent.push_back(
        {this->random.uniform(-0.1, 0.1), this->random.uniform(-0.1, 0.1), this->random.uniform(-0.1, 0.1)});
  }
  const auto error_after = [&](int steps) {
    Path path(mesh, law, this->chosen());
    const NodalField start = path.to(bent);
    NodalField force;
    const double quarter = std::acos(0.0);
    for (int n = 1; n <= steps; ++n) {
      const Tensor<double> R = turn_about_z(quarter * n / steps);
      NodalField u;
      for (std::size_t p = 0; p < 8; ++p) {
        const Vector X = mesh.points[p];
        const Vector x = linear(R, {X[0] + bent[p][0], X[1] + bent[p][1], X[2] + bent[p][2]});
        u.push_back({x[0] - X[0], x[1] - X[1], x[2] - X[2]});
      }
      force = path.to(u, short_step);
    }
    return largest_distance(force, turned(start, turn_about_z(quarter))) / largest_component(start);
  };
  const double coarse = error_after(50), fine = error_after(100);
  if constexpr (TestFixture::Kernel::remembers) {
    EXPECT_LT(fine, 1e-3);
    EXPECT_NEAR(coarse / fine, 4.0, 0.2);
  } else {
    EXPECT_LT(fine, 1e-11);
  }
}

TYPED_TEST(UpdatedLagrangianTest, forces_balance_momentum_and_angular_momentum) {
  for (int n = 0; n < 20; ++n) {
    const auto X = this->random.hexahedron();
    typename TestFixture::Element element(X, law, {.density = 1000.0});
    for (int step = 1; step <= 3; ++step) {
      const auto u = this->random.displacements(X, 0.8, 1.3, 0.1);
      const auto f = element.to(u, 1.0);
      const auto x = X + u;
      const double tolerance = 8 * this->tolerance(element, x);
      for (int i = 0; i < 3; ++i) {
        double sum = 0.0;
        for (int I = 0; I < 8; ++I) sum += f(I, i);
        EXPECT_NEAR(sum, 0.0, tolerance);
      }
      const Tensor<double> moment = transpose(x) * f;  // symmetric when sum x cross f = 0
      EXPECT_LT(largest_entry(moment - transpose(moment)), 8 * tolerance * largest_entry(x));
    }
  }
}

/// In one step from the undeformed shape the resistances do the work 2 E, where E is the energy that the
/// control reports; without velocity, the damper does none.
TYPED_TEST(UpdatedLagrangianTest, stores_the_work_of_one_step) {
  for (int n = 0; n < 20; ++n) {
    const auto X = this->random.hexahedron();
    const auto u = this->random.displacements(X, 0.8, 1.3, 0.1);
    typename TestFixture::Element controlled(X, law);
    SingleElement<typename TestFixture::UncontrolledKernel, NeoHookean> uncontrolled(X, law);
    const auto resisting = controlled.to(u) - uncontrolled.to(u);
    const double work = double_dot(resisting, u);
    const double energy = controlled.energy().hourglass;
    EXPECT_NEAR(energy, 0.5 * work, this->tolerance(controlled, X) * largest_entry(X + u));
    if (TestFixture::resists_displacements) {
      EXPECT_GT(energy, 0.0);
    } else {
      EXPECT_EQ(energy, 0.0);
    }
  }
}

/// The 24 ways to number the nodes of one element, along a path that bends, stretches and turns it.
TYPED_TEST(UpdatedLagrangianTest, node_ordering_does_not_matter) {
  for (int n = 0; n < 4; ++n) {
    const auto X = this->random.hexahedron();
    const std::array<NodalVectors<double>, 3> path{this->random.displacements(X, 0.9, 1.1, 0.1),
                                                   this->random.displacements(X, 0.7, 1.4, 0.15),
                                                   this->random.displacements(X, 0.7, 1.4, 0.15)};
    const auto force_on = [&](const std::array<int, 8>& ordering) {
      typename TestFixture::Element element(reordered(X, ordering), law, {.density = 1000.0});
      NodalVectors<double> f;
      for (const auto& u : path) f = element.to(reordered(u, ordering), 1.0);
      return std::pair{f, this->tolerance(element, X)};
    };
    const auto [f, tolerance] = force_on({0, 1, 2, 3, 4, 5, 6, 7});
    for (const auto& ordering : proper_orderings()) {
      EXPECT_LT(largest_entry(force_on(ordering).first - reordered(f, ordering)), 8 * tolerance);
    }
  }
}

/// The bound of the stable step at its own step: velocities are half a step late, so that stability requires
/// lambda_max(K + 2/dt D) <= 4 m / dt^2 = bound, D the damping. The kernel on dual numbers, in one step from
/// the undeformed shape with the inverse step 2/dt, gives that sum. The mean rejects bounds that are huge.
TYPED_TEST(UpdatedLagrangianTest, bound_of_the_stable_step_holds) {
  using DualElement = SingleElement<typename TestFixture::Kernel, NeoHookean, D>;
  for (const double kappa : {0.1, 1.0}) {
    if (!TypeParam::Hourglass::traits.takes_kappa && kappa != 0.1) continue;
    double mean = 0.0;
    constexpr int samples = 100;
    for (int n = 0; n < samples; ++n) {
      const auto X = this->random.hexahedron();
      const double density = 1000.0;
      const auto sample = sample_law<NeoHookean>(poisson_ratios[index(n) % poisson_ratios.size()]);
      HourglassSettings settings{.density = density};
      if (TypeParam::Hourglass::traits.takes_kappa) settings.kappa = kappa;
      const auto constants = TestFixture::Kernel::precompute(X, sample, settings);
      typename TestFixture::Element undeformed(X, sample, constants);
      undeformed.to({});
      const double bound = undeformed.stiffness_bound();
      const double dt = 2 * std::sqrt(density * mean_gradient(X).volume / 8 / bound);
      Matrix<double, 24, 24> K;
      for (int column = 0; column < 24; ++column) {
        DualElement element(X, sample, dual_element<typename TestFixture::Kernel>(constants));
        const auto direction = unit<8, 3>(static_cast<std::size_t>(column));
        const auto f = slope(element.to(along(NodalVectors<double>{}, direction), 2 / dt));
        for (int m = 0; m < 24; ++m) K(m, column) = f.entries[static_cast<std::size_t>(m)];
      }
      const double truth = eigenvalues(K).back();
      EXPECT_LE(truth, bound * (1 + 1e-12));
      mean += truth / bound / samples;
    }
    EXPECT_GT(mean, 0.44) << "kappa " << kappa;  // as for the Total Lagrangian methods
  }
}

/// Forces at strains of eps: the reference and current geometries differ by eps.
TYPED_TEST(UpdatedLagrangianTest, forces_agree_with_total_lagrangian_to_first_order) {
  using TotalKernel = NodalForm<FormulationOf<typename TypeParam::AtSmallStrain, NeoHookean>>;
  for (int n = 0; n < 20; ++n) {
    const auto X = this->random.hexahedron();
    const auto shape = this->random.displacements(X, 0.8, 1.2, 0.1);
    const auto relative_difference = [&](double strain) {
      const NodalVectors<double> u = strain * shape;
      typename TestFixture::Element updated(X, law);
      const auto exact = TotalKernel::force(u, TotalKernel::precompute(X, law, {}), law);
      return largest_entry(updated.to(u) - exact) / largest_entry(exact);
    };
    const double large = relative_difference(1e-3), small = relative_difference(1e-4);
    EXPECT_LT(large, 0.05);
    EXPECT_GT(large / small, 5.0);
  }
}

/// A cantilever bent far: the two formulations measure hourglass modes in the reference and in the current
/// configuration, a difference of first order in strain of a small force.
Scene bent_cantilever(double deflection) {
  Case description = plain_case(law);
  const Mesh mesh = box({1.0, 0.2, 0.2}, {10, 2, 2});
  const NodeSets sets{{"foot", nodes_where(mesh.points, [](const Vector& X) { return X[0] == 0.0; })},
                      {"head", nodes_where(mesh.points, [](const Vector& X) { return X[0] > 0.99; })}};
  description.displacements = {{"foot", {}}, {"head", {0.0, 0.0, deflection}}};
  description.relaxation.tolerance = 1e-10;
  return make_scene(description, mesh, sets);
}

NodalField relaxed(const Scene& scene, const MethodChoice& choice) {
  Observer silent;
  return relax(Model(scene, choice), silent).u;
}

/// Controls without static forces are not tested: their final state is arbitrary.
TEST(UpdatedLagrangian, agrees_with_total_lagrangian_to_first_order_in_strain) {
  for_each_type(Methods{}, []<class Method>() {
    if constexpr (std::is_same_v<typename Method::Kinematics, UpdatedOnePoint>) {
      if (zero_energy_modes<Method>() != 6) return;
      SCOPED_TRACE(Method::name);
      const auto relative_difference = [](double deflection) {
        const Scene scene = bent_cantilever(deflection);
        const NodalField updated = relaxed(scene, method(Method::name));
        return largest_distance(updated, relaxed(scene, method(Method::AtSmallStrain::name))) / deflection;
      };
      const double large = relative_difference(0.2), small = relative_difference(0.02);
      EXPECT_LT(large, 2e-3);
      EXPECT_GT(large / small, 5.0);
    }
  });
}

/// At strains of tens of percent the difference is less than that of a kappa larger or smaller by a quarter:
/// the current geometry scales the stiffness of the modes by about the square of a stretch.
TEST(UpdatedLagrangian, differs_less_than_kappa_by_a_quarter) {
  const Scene scene = bent_cantilever(0.2);
  const double kappa = *method_named("tl-perturbation").auto_kappa(CalledLaw(law), KappaModulus::p_wave);
  const NodalField total = relaxed(scene, method("tl-perturbation", kappa));
  const NodalField updated = relaxed(scene, method("ul-perturbation", kappa));
  const double spread = largest_distance(relaxed(scene, method("tl-perturbation", 0.75 * kappa)),
                                         relaxed(scene, method("tl-perturbation", 1.25 * kappa)));
  EXPECT_LT(largest_distance(total, updated), spread);
}

}  // namespace
}  // namespace sandglass::verification::updated_lagrangian_test
