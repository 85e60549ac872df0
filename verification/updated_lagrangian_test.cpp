/// The Updated Lagrangian twin of the paper's method: what it must share with the Total Lagrangian one, and
/// how far apart the two may be.

#include <gtest/gtest.h>

#include "stepping/relaxation.hpp"
#include "support/patch_mesh.hpp"
#include "support/path.hpp"
#include "support/random_hexahedra.hpp"
#include "support/typed_lists.hpp"

namespace sandglass::verification {
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

/// Stretch and turn at once: F(s) on the way from I.
Tensor<double> on_the_way(double s) {
  const Tensor<double> stretch{{1 + 0.4 * s, 0.2 * s, 0, 0, 1 - 0.2 * s, 0.1 * s, 0, 0, 1 + 0.1 * s}};
  return turn_about_z(1.5 * s) * stretch;
}

NodalField turned(const NodalField& field, const Tensor<double>& R) {
  NodalField result;
  for (const auto& row : field) result.push_back(linear(R, row));
  return result;
}

/// The patch test of a method that integrates: along an affine path of a distorted mesh no hourglass velocity
/// arises, so that at its end the forces are those of the Total Lagrangian element, V h P^T, and the inner
/// nodes feel none. Roundoff of 400 steps: each leaves eps of the coordinates in the resistances.
TEST(UpdatedLagrangianTest, affine_path_passes_the_patch_test) {
  const Mesh mesh = macneal_harder_patch();
  Path updated(mesh, law, method("ul-perturbation"));
  Path total(mesh, law, method("tl-perturbation"));
  constexpr int steps = 400;
  NodalField force;
  for (int n = 1; n <= steps; ++n) {
    force = updated.to(map_points(mesh, on_the_way(static_cast<double>(n) / steps)));
  }
  const NodalField exact = total.to(map_points(mesh, on_the_way(1.0)));
  const double tolerance = 64 * eps * steps * law.bulk_modulus();
  EXPECT_LT(largest_distance(force, exact), tolerance);
  for (int n = 0; n < first_corner; ++n) {
    for (const double f : force[index(n)]) EXPECT_NEAR(f, 0.0, tolerance);
  }
}

TEST(UpdatedLagrangianTest, rigid_rotation_gives_no_force) {
  const Mesh mesh = macneal_harder_patch();
  Path updated(mesh, law, method("ul-perturbation"));
  constexpr int steps = 400;
  for (int n = 1; n <= steps; ++n) {
    const NodalField force = updated.to(map_points(mesh, turn_about_z(6.3 * n / steps)));
    EXPECT_LT(largest_component(force), 64 * eps * n * law.bulk_modulus());
  }
}

/// A bent element that turns by 90 degrees keeps its forces and takes them along. The spin of one step is
/// taken at its end, sin(angle) for angle: the turn is short by angle^3/4 per step, that is by the square of
/// the step in all.
TEST(UpdatedLagrangianTest, resistances_turn_with_the_element) {
  const Mesh mesh = box({1, 1, 1}, {1, 1, 1});
  RandomGeometry random(5);
  NodalField bent;
  for (std::size_t n = 0; n < 8; ++n) {
    bent.push_back({random.uniform(-0.1, 0.1), random.uniform(-0.1, 0.1), random.uniform(-0.1, 0.1)});
  }
  const auto error_after = [&](int steps) {
    Path path(mesh, law, method("ul-perturbation", 0.1));
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
      force = path.to(u);
    }
    return largest_distance(force, turned(start, turn_about_z(quarter))) / largest_component(start);
  };
  const double coarse = error_after(50), fine = error_after(100);
  EXPECT_LT(fine, 1e-3);
  EXPECT_NEAR(coarse / fine, 4.0, 0.2);
}

/// A cantilever bent far: the two formulations measure hourglass modes in the reference and in the current
/// configuration, which is a difference of first order in strain of a small force.
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

TEST(UpdatedLagrangianTest, agrees_with_total_lagrangian_to_first_order_in_strain) {
  const auto relative_difference = [](double deflection) {
    const Scene scene = bent_cantilever(deflection);
    const NodalField updated = relaxed(scene, method("ul-perturbation"));
    return largest_distance(updated, relaxed(scene, method("tl-perturbation"))) / deflection;
  };
  const double large = relative_difference(0.2), small = relative_difference(0.02);
  EXPECT_LT(large, 2e-3);
  EXPECT_GT(large / small, 5.0);
}

/// At strains of tens of percent the difference is less than what kappa a quarter larger or smaller makes:
/// the current geometry scales the stiffness of the modes by about the square of a stretch.
TEST(UpdatedLagrangianTest, differs_less_than_kappa_by_a_quarter) {
  const Scene scene = bent_cantilever(0.2);
  const double kappa = *auto_kappa("tl-perturbation", law);
  const NodalField total = relaxed(scene, method("tl-perturbation", kappa));
  const NodalField updated = relaxed(scene, method("ul-perturbation", kappa));
  const double spread = largest_distance(relaxed(scene, method("tl-perturbation", 0.75 * kappa)),
                                         relaxed(scene, method("tl-perturbation", 1.25 * kappa)));
  EXPECT_LT(largest_distance(total, updated), spread);
}

}  // namespace
}  // namespace sandglass::verification
