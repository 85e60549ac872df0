/// Independence of results from the number of threads, the width of the kernel and the precision.

#include <gtest/gtest.h>

#include <tuple>

#include "base/error.hpp"
#include "element/methods.hpp"
#include "math/pack.hpp"
#include "mesh/quality.hpp"
#include "solve/central_difference.hpp"
#include "support/mesh_kinds.hpp"
#include "support/method_test.hpp"
#include "support/path.hpp"
#include "support/random_hexahedra.hpp"

namespace sandglass::verification::assembly_test {
namespace {

const NeoHookean law{.young_modulus = 3000.0, .poisson_ratio = 0.49};

/// A displacement field that is not linear in any element, at most a tenth of a small element, and less where
/// that would invert an element of the method.
NodalField wavy(const Mesh& mesh, const std::string& method) {
  RandomGeometry random(3);
  const double size = std::cbrt(mean_gradient(gather(mesh.points, mesh.cells.front())).volume);
  NodalField u(mesh.points.size());
  for (auto& row : u) {
    for (double& x : row) x = 0.1 * size * random.uniform(-1, 1);
  }
  const auto elements = std::get<0>(make_internal_force(mesh, law, {method}));
  std::vector<double> jacobians(mesh.cells.size());
  for (;;) {
    elements->smallest_jacobians(state_at(*elements, u), jacobians);
    if (*std::ranges::min_element(jacobians) > 0.0) return u;
    for (auto& row : u) {
      for (double& x : row) x *= 0.5;
    }
  }
}

class AssemblyTest : public MethodTest {};
INSTANTIATE_TEST_SUITE_P(, AssemblyTest, each_of(Methods{}), method_label);

/// Forces after two steps of a path, so that methods with memory have something to remember.
NodalField forces(const Mesh& mesh, const MethodChoice& choice) {
  Path path(mesh, law, choice);
  const NodalField u = wavy(mesh, choice.method);
  NodalField half = u;
  for (auto& row : half) {
    for (double& x : row) x *= 0.5;
  }
  path.to(half);
  return path.to(u);
}

/// Nodal forces at a face between two elements are not summed in the order of the nodes; each is a sum of at
/// most eight elements' forces, of the order of the bulk modulus times size squared.
double tolerance(const Mesh& mesh, double epsilon) {
  const double area = std::pow(mean_gradient(gather(mesh.points, mesh.cells.front())).volume, 2.0 / 3.0);
  return 64 * epsilon * law.bulk_modulus() * area;
}

TEST_P(AssemblyTest, packs_give_the_forces_of_plain_numbers) {
  for (const Mesh& mesh : meshes(GetParam())) {
    MethodChoice scalar = choice();
    scalar.kernel = KernelWidth::scalar;
    EXPECT_LT(largest_distance(forces(mesh, choice()), forces(mesh, scalar)), tolerance(mesh, 2.3e-16));
  }
}

TEST_P(AssemblyTest, threads_do_not_change_a_bit) {
  for (const Mesh& mesh : meshes(GetParam())) {
    const NodalField one = forces(mesh, choice());
    EXPECT_EQ(forces(mesh, choice()), one);  // nor does a second run
    for (const int threads : {2, 3, 4}) {
      EXPECT_EQ(forces(mesh, choice(Precision::double_precision, threads)), one);
    }
  }
}

TEST_P(AssemblyTest, numbering_of_the_mesh_does_not_matter) {
  Mesh mesh = box({1, 2, 3}, {3, 4, 5});
  const NodalField u = wavy(mesh, GetParam());
  const NodalField f = Path(mesh, law, choice()).to(u);
  Mesh reversed = mesh;
  std::ranges::reverse(reversed.points);
  std::ranges::reverse(reversed.cells);
  const int last = static_cast<int>(mesh.points.size()) - 1;
  for (auto& cell : reversed.cells) {
    for (int& node : cell) node = last - node;
  }
  NodalField reversed_u(u.rbegin(), u.rend());
  NodalField g = Path(reversed, law, choice()).to(reversed_u);
  std::ranges::reverse(g);
  EXPECT_LT(largest_distance(f, g), tolerance(mesh, 2.3e-16));
}

/// Single precision: unit roundoff 6e-8 in place of 1.1e-16.
TEST_P(AssemblyTest, single_precision_is_as_near_as_its_digits) {
  for (const Mesh& mesh : meshes(GetParam())) {
    const auto elements = std::get<1>(make_internal_force(mesh, law, choice(Precision::single_precision)));
    State<float> state = state_at(*elements, wavy(mesh, GetParam()));
    Rows<float> force(state.u.size());
    elements->evaluate(state, force);
    const NodalField exact = Path(mesh, law, choice()).to(wavy(mesh, GetParam()));
    EXPECT_LT(largest_distance(to_field(force, elements->layout()), exact), tolerance(mesh, 1.2e-7));
  }
}

/// Energies of equal elements add up without drift: summed in single precision, the last of so many would all
/// be rounded in the same direction, by the digits of the whole sum. A node's displacement is at most 2.5 and
/// rounded to 6e-8 of that, strains to twice that over .1, and energies go with their squares: 6e-6; the rest
/// is the kernel's rounding.
TEST_P(AssemblyTest, energies_of_many_elements_add_up_in_single_precision) {
  const Mesh mesh = box({24, 24, 24}, {24, 24, 24});
  NodalField u;
  for (const auto& X : mesh.points) {
    const double zigzag = std::lround(X[0] + X[1] + X[2]) % 2 == 0 ? 0.05 : -0.05;
    u.push_back({0.1 * X[0] + zigzag, -0.03 * X[1], 0.02 * X[2]});
  }
  const auto exact = std::get<0>(make_internal_force(mesh, law, choice()));
  const auto elements = std::get<1>(make_internal_force(mesh, law, choice(Precision::single_precision)));
  const StrainEnergies wanted = exact->energies(state_at(*exact, u));
  const StrainEnergies found = elements->energies(state_at(*elements, u));
  EXPECT_NEAR(found.strain / wanted.strain, 1.0, 1e-5);
  EXPECT_NEAR(found.hourglass, wanted.hourglass, 1e-5 * wanted.strain);
}

/// A body 1000 of its lengths from the origin: coordinates enter as differences or relative to the body's
/// middle, so single precision loses no more than at the origin, except for the rounding of the coordinates
/// themselves, which is that of double precision.
TEST_P(AssemblyTest, distance_from_the_origin_costs_single_precision_nothing) {
  const Mesh here = box({1, 1, 2}, {3, 3, 6});
  Mesh far = here;
  for (auto& X : far.points) {
    for (double& x : X) x += 2000.0;
  }
  const auto force = [&](const Mesh& mesh) {
    const auto elements = std::get<1>(make_internal_force(mesh, law, choice(Precision::single_precision)));
    State<float> state = state_at(*elements, wavy(here, GetParam()));
    Rows<float> rows(state.u.size());
    elements->evaluate(state, rows);
    return to_field(rows, elements->layout());
  };
  EXPECT_LT(largest_distance(force(here), force(far)), tolerance(here, 1.2e-7));
}

/// A kappa that would be ignored is rejected.
TEST_P(AssemblyTest, kappa_is_taken_or_refused) {
  const MethodChoice with_kappa{GetParam(), 0.037};
  if (method.takes_kappa) {
    EXPECT_NO_THROW(make_internal_force(box({1, 1, 1}, {1, 1, 1}), law, with_kappa));
  } else {
    EXPECT_THROW(make_internal_force(Mesh{}, law, with_kappa), InputError);
  }
}

/// A complete motion: the same bits for any number of threads.
TEST_P(AssemblyTest, motion_is_the_same_to_the_bit_for_any_number_of_threads) {
  Case description = plain_case(law);
  description.quasi_static = false;
  description.dynamics.duration = 0.02;
  description.velocities = {{.value = {0.3, 0.1, -0.2}}};
  const Mesh mesh = box({0.1, 0.1, 0.4}, {5, 5, 20});
  const NodeSets sets{{"foot", nodes_where(mesh.points, [](const Vector& X) { return X[2] == 0.0; })}};
  description.displacements = {{"foot", {}}};
  const Scene scene = make_scene(description, mesh, sets);
  if (method.is_condensed) {
    Observer silent;
    EXPECT_THROW(integrate(Model(scene, choice()), silent), InputError);
    return;
  }
  const auto motion = [&](int threads, Precision precision) {
    Observer silent;
    return integrate(Model(scene, choice(precision, threads)), silent);
  };
  for (const Precision precision : {Precision::double_precision, Precision::single_precision}) {
    const Motion one = motion(1, precision);
    for (const int threads : {2, 4}) {
      const Motion many = motion(threads, precision);
      EXPECT_EQ(one.u, many.u);
      EXPECT_EQ(one.v, many.v);
      EXPECT_EQ(one.steps, many.steps);
    }
  }
}

/// Displacements that decay into the subnormal range count as zero, and the caller's floating-point mode is
/// restored.
TEST(SubnormalTest, fading_displacements_give_no_force_and_leave_the_processor_as_it_was) {
  const Mesh mesh = box({1, 1, 1}, {2, 2, 2});
  const auto elements =
      std::get<1>(make_internal_force(mesh, law, {"tl-perturbation", {}, Precision::single_precision}));
  State<float> state = elements->undeformed();
  for (auto& row : state.u) row = {{1e-40F, -2e-40F, 3e-40F, 0.0F}};
  Rows<float> force(state.u.size());
  elements->evaluate(state, force);
  EXPECT_EQ(largest_distance(to_field(force, elements->layout()), NodalField(mesh.points.size())), 0.0);
  const volatile float tiny = 1e-30F, less = 1e-10F;
  EXPECT_GT(tiny * less, 0.0F);
}

/// The compact method has no special form for parallelepipeds: all its results must equal those of the method
/// that has one, for laws of all kinds. Bounds and energies are sums like the forces, with the same rounding.
TEST(ParallelepipedTest, form_for_them_gives_what_the_general_one_gives) {
  const Mesh mesh = sheared_box();
  ASSERT_EQ(shapes_in(mesh), Shapes::parallelepipeds);
  const Ogden ogden{.mu1 = 800.0, .alpha1 = 3.0, .K = 5e4};
  for (const AnyLaw& any : {AnyLaw(law), AnyLaw(ogden)}) {
    const auto regular = std::get<0>(make_internal_force(mesh, any, {"tl-perturbation"}));
    const auto general = std::get<0>(make_internal_force(mesh, any, {"tl-perturbation-compact"}));
    const NodalField u = wavy(mesh, "tl-perturbation");
    const auto results = [&](const InternalForce<double>& elements) {
      State<double> state = state_at(elements, u);
      Rows<double> force(state.u.size());
      elements.evaluate(state, force);
      std::vector<double> bounds(mesh.cells.size()), jacobians(bounds), densities(bounds);
      elements.stiffness_bounds(state, bounds);
      elements.smallest_jacobians(state, jacobians);
      elements.hourglass_energy_densities(state, densities);
      return std::tuple(to_field(force, elements.layout()), elements.energies(state), bounds, jacobians,
                        densities);
    };
    const auto [f, energies, bounds, jacobians, densities] = results(*regular);
    const auto [f2, energies2, bounds2, jacobians2, densities2] = results(*general);
    EXPECT_LT(largest_distance(f, f2), tolerance(mesh, 2.3e-16));
    EXPECT_NEAR(energies.strain / energies2.strain, 1.0, 1e-12);
    EXPECT_NEAR(energies.hourglass / energies2.hourglass, 1.0, 1e-12);
    for (std::size_t e = 0; e < bounds.size(); ++e) {
      EXPECT_NEAR(bounds[e] / bounds2[e], 1.0, 1e-12);
      EXPECT_NEAR(jacobians[e] / jacobians2[e], 1.0, 1e-12);
      EXPECT_NEAR(densities[e] / densities2[e], 1.0, 1e-11);
    }
  }
}

/// A node moved by a billionth of an edge is not roundoff: c = 0 would be wrong by as much.
TEST(ParallelepipedTest, is_not_what_differs_from_one_by_more_than_roundoff) {
  Mesh mesh = sheared_box();
  for (auto& X : mesh.points) X[1] += 100.0;  // coordinates are now rounded to 1e-14
  EXPECT_EQ(shapes_in(mesh), Shapes::parallelepipeds);
  mesh.points[100][2] += 1e-9;
  EXPECT_EQ(shapes_in(mesh), Shapes::any);
}

/// Recomputing the geometry changes only roundoff.
TEST(CompactMethodTest, gives_the_forces_of_the_method_it_stands_for) {
  for (const Mesh& mesh : meshes()) {
    const NodalField loaded = forces(mesh, {"tl-perturbation"});
    const NodalField computed = forces(mesh, {"tl-perturbation-compact"});
    EXPECT_LT(largest_distance(loaded, computed), tolerance(mesh, 2.3e-16));
  }
}

template <class Number>
class RowsTest : public ::testing::Test {};
using RowNumbers = ::testing::Types<double, float, Pack<double, 2>, Pack<double, 4>, Pack<double, 8>,
                                    Pack<float, 4>, Pack<float, 8>, Pack<float, 16>>;
TYPED_TEST_SUITE(RowsTest, RowNumbers);

/// Small whole numbers, so that sums are exact in any order; two lanes name the same row.
TYPED_TEST(RowsTest, gather_and_scatter_reach_the_rows_of_their_lanes) {
  using Real = typename Lanes<TypeParam>::Scalar;
  constexpr int width = Lanes<TypeParam>::width;
  constexpr std::array<std::size_t, 16> row{3, 17, 5, 5, 0, 2, 39, 11, 12, 13, 22, 21, 20, 7, 8, 9};
  Rows<Real> values(40), sums(40), expected(40);
  for (std::size_t n = 0; n < 40; ++n) {
    for (std::size_t i = 0; i < 3; ++i) values[n][i] = static_cast<Real>(10 * n + i);
  }
  std::array<Place, 16> places{};
  for (std::size_t l = 0; l < 16; ++l) places[l] = place_of_row(row[l]);
  const auto x = sandglass::gather<TypeParam>(numbers_of(std::as_const(values)), places.data());
  for (int lane = 0; lane < width; ++lane) {
    for (std::size_t i = 0; i < 3; ++i) {
      EXPECT_EQ(Lanes<TypeParam>::get(x[i], lane), values[row[index(lane)]][i]);
      expected[row[index(lane)]][i] += values[row[index(lane)]][i];
    }
  }
  sandglass::scatter_add<TypeParam>(x, numbers_of(sums), places.data());
  for (std::size_t n = 0; n < 40; ++n) {
    for (std::size_t i = 0; i < 4; ++i) EXPECT_EQ(sums[n][i], expected[n][i]) << n << ' ' << i;
  }
}

}  // namespace
}  // namespace sandglass::verification::assembly_test
