/// Every kind of force by itself, without a body: its contributions to frequencies, to the stiffness and to
/// the size of the load, its forces in a motion, and the same force on a part of the mesh. Exact answers.

#include <gtest/gtest.h>

#include <cmath>
#include <numeric>

#include "forces/forces.hpp"
#include "mesh/box.hpp"

namespace sandglass::verification::force_test {
namespace {

/// Three unit vectors along the edges of a turned box.
constexpr std::array<Vector, 3> axes{
    {{2.0 / 3, 2.0 / 3, -1.0 / 3}, {-1.0 / 3, 2.0 / 3, 2.0 / 3}, {2.0 / 3, -1.0 / 3, 2.0 / 3}}};
constexpr double largest_factor = 2.0;

/// Two elements side by side under a plane surface made of a rectangle of 1 x 3 and a trapezoid with parallel
/// sides of 1 and 3 at a distance of 3; turned, so that no component of its normal is zero. The nodes have
/// the masses 1, 2, 3, ... kg.
struct Surface {
  Mesh mesh = BoxMesh{{2.0, 3.0, 1.0}, {2, 1, 1}}.build();
  std::vector<Quadrilateral> boundary = boundary_faces(mesh.cells);
  NodeSets sets;
  std::vector<double> masses = std::vector<double>(12);
  std::vector<double> shares = std::vector<double>(12);  // of the surface's area, integrals of N_I, m^2
  std::vector<double> edges = std::vector<double>(12);   // sums of the longer edges of faces, m
  ForceResolver resolver{"a.toml", mesh.points, boundary, sets, masses};

  Surface() {
    std::iota(masses.begin(), masses.end(), 1.0);
    // Where the width is 2 + eta, the integral of (1 -+ eta) (2 + eta) 3/8 is 5/4 and 7/4.
    const double side = std::sqrt(13.0);
    for (std::size_t n = 0; n < 12; ++n) {
      Vector& X = mesh.points[n];
      if (X[2] != 1.0) continue;
      sets["surface"].push_back(static_cast<int>(n));
      const bool far = X[1] == 3.0;
      if (X[0] < 2.0) shares[n] += 0.75, edges[n] += 1.0 + 3.0;
      if (X[0] > 0.0) shares[n] += far ? 1.75 : 1.25, edges[n] += 3.0 + side;
      if (far && X[0] == 2.0) X[0] = 4.0;
    }
    for (Vector& X : mesh.points) X = combined(X);
  }

  /// The vector with these components along the axes of the box.
  static Vector combined(const Vector& along) {
    Vector x{};
    for (std::size_t a = 0; a < 3; ++a) {
      for (std::size_t i = 0; i < 3; ++i) x[i] += along[a] * axes[a][i];
    }
    return x;
  }

  template <class Kind>
  std::shared_ptr<const BodyForce> made(const Kind& kind) {
    kind.resolve(resolver);
    return resolver.all().back();
  }
};

/// All contributions of a force, with the largest factor for all curves.
struct Added {
  std::vector<LoadRates> rates;
  Rows<float> stiffness;
  Rows<double> forces;
  double size = 0.0;

  /// With all nodes displaced by u (m), after an increment of `increment` (m) in a step (s).
  explicit Added(const BodyForce& force, const std::vector<double>& masses, const Vector& u = {},
                 const Vector& increment = {}, double step = 0.0)
      : rates(masses.size()), stiffness(masses.size()), forces(masses.size()) {
    std::vector<int> places(masses.size());
    std::iota(places.begin(), places.end(), 0);
    const std::vector<double> factors(3, largest_factor);
    const Rows<double> all_u(masses.size(), {{u[0], u[1], u[2]}}),
        all_increments(masses.size(), {{increment[0], increment[1], increment[2]}});
    force.add_rates(factors, masses, rates);
    force.add_stiffness({stiffness.data(), places});
    force.add_forces(factors, {{all_u.data(), places}, {all_increments.data(), places}, step},
                     {forces.data(), places});
    force.add_size(10.0, size);
  }
};

void expect_force(const Row<double>& force, const Vector& expected, std::size_t node) {
  for (std::size_t i = 0; i < 3; ++i) EXPECT_NEAR(force[i], expected[i], 1e-12) << node;
}

/// A pressure on plane faces pushes on nodes by their shares of the area, and its tangent is at most half the
/// sum of the longer edges times the largest pressure.
TEST(Force, pressure_acts_on_plane_faces_as_derived) {
  Surface surface;
  const auto force = surface.made(Pressure{"surface", -7.0});
  const Added added(*force, surface.masses, {0.1, 0.2, 0.3});
  for (std::size_t n = 0; n < 12; ++n) {
    const double along = largest_factor * 7.0 * surface.shares[n];
    expect_force(added.forces[n], {along * axes[2][0], along * axes[2][1], along * axes[2][2]}, n);
    EXPECT_NEAR(added.rates[n].square, 0.5 * surface.edges[n] * 7.0 * largest_factor / surface.masses[n],
                1e-12);
    EXPECT_EQ(added.rates[n].damping, 0.0);
    for (std::size_t i = 0; i < 3; ++i) EXPECT_EQ(added.stiffness[n][i], 0.0F);
  }
  EXPECT_NEAR(added.size, 7.0 * 9.0, 1e-12);
  EXPECT_TRUE(force->traits().drives);
  EXPECT_FALSE(force->traits().dissipates);
  EXPECT_FALSE(force->traits().no_potential.empty());
}

/// When all nodes move alike, springs and dashpots resist by their shares of the area: the whole motion, or
/// its part along the normal. Springs alone need no time step.
TEST(Force, supports_act_on_plane_faces_as_derived) {
  const Vector u{0.1, -0.2, 0.4}, increment{0.03, 0.01, 0.02};
  const auto normal_part = [](const Vector& v) {
    const double along = v[0] * axes[2][0] + v[1] * axes[2][1] + v[2] * axes[2][2];
    return Surface::combined({0.0, 0.0, along});
  };
  for (const bool only_normal : {false, true}) {
    for (const double damping : {0.0, 0.5}) {
      Surface surface;
      const double k = 11.0, step = damping > 0.0 ? 0.25 : 0.0, rate = damping > 0.0 ? damping / step : 0.0;
      const auto force = surface.made(Support{"surface", k, damping, only_normal});
      const Added added(*force, surface.masses, u, increment, step);
      const Vector a = only_normal ? normal_part(u) : u, b = only_normal ? normal_part(increment) : increment;
      for (std::size_t n = 0; n < 12; ++n) {
        const double share = surface.shares[n];
        Vector expected{};
        for (std::size_t i = 0; i < 3; ++i) {
          expected[i] = -share * (k * a[i] + rate * b[i]);
          const double directed = only_normal ? axes[2][i] * axes[2][i] : 1.0;
          EXPECT_NEAR(added.stiffness[n][i], k * share * directed, 1e-6 * k * 9.0);  // of floats
        }
        expect_force(added.forces[n], expected, n);
        EXPECT_NEAR(added.rates[n].square, k * share / surface.masses[n], 1e-12);
        EXPECT_NEAR(added.rates[n].damping, damping * share / surface.masses[n], 1e-12);
      }
      EXPECT_EQ(added.size, 0.0);
      EXPECT_FALSE(force->traits().drives);
      EXPECT_EQ(force->traits().dissipates, damping > 0.0);
      EXPECT_TRUE(force->traits().no_potential.empty());
    }
  }
}

/// Forces are minus the derivative of the potential; for a pressure, on a closed surface. Potentials are
/// below 1000 J and at most quadratic in one coordinate, so that only rounding over h remains: 1e-9.
TEST(Force, derives_from_its_potential) {
  const auto compare = [](const auto& kind) {
    Surface surface;
    surface.sets["all"].resize(12);
    std::iota(surface.sets["all"].begin(), surface.sets["all"].end(), 0);
    const auto force = surface.made(kind);
    std::vector<int> places(12);
    std::iota(places.begin(), places.end(), 0);
    const std::vector<double> factors(2, largest_factor);
    Rows<double> u(12), forces(12);
    for (std::size_t n = 0; n < 12; ++n) {
      for (std::size_t i = 0; i < 3; ++i) u[n][i] = 0.1 * std::sin(static_cast<double>(1 + 3 * n + i));
    }
    const Rows<double>& moved = u;
    const NodalRows at_nodes{moved.data(), places};
    force->add_forces(factors, {at_nodes, at_nodes, 1.0}, {forces.data(), places});
    const auto potential = [&] {
      double sum = 0.0;
      force->add_potential(factors, at_nodes, sum);
      return sum;
    };
    for (std::size_t n = 0; n < 12; ++n) {
      for (std::size_t i = 0; i < 3; ++i) {
        const double h = 1e-3, there = u[n][i];
        u[n][i] = there + h;
        const double up = potential();
        u[n][i] = there - h;
        EXPECT_NEAR(forces[n][i], (potential() - up) / (2.0 * h), 1e-9) << force->traits().name << n;
        u[n][i] = there;
      }
    }
  };
  compare(DeadForce{.set = "surface", .total = {1.0, 2.0, 3.0}, .moment = {4.0, 5.0, 6.0}});
  compare(Gravity{{1.0, 2.0, 3.0}});
  compare(Pressure{"all", 7.0});
  compare(Pressure{"all", 1.0 / largest_factor});  // 1 Pa
  compare(Support{"surface", 11.0, 0.0, false});
  compare(Support{"surface", 11.0, 0.0, true});
}

/// Dead forces and weight are combined into one force, the first of the list in any order of tables, sorted
/// by curve and node.
TEST(Force, dead_loads_are_added_up) {
  Surface surface;
  Pressure{"surface", 1.0}.resolve(surface.resolver);
  const Vector total{0.0, 3.0, 4.0}, moment{5.0, 0.0, 12.0}, weight{0.0, 0.6, -0.8};
  DeadForce{.set = "surface", .total = total, .moment = moment}.resolve(surface.resolver);
  Gravity{weight, {{0.0, 1.0}, {0.0, 1.0}}}.resolve(surface.resolver);
  const BodyForces forces = surface.resolver.all();
  ASSERT_EQ(forces.size(), 2U);
  EXPECT_EQ(first_not_dead(forces), forces[1].get());
  EXPECT_EQ(first_not_dead({forces[0]}), nullptr);
  const auto loads = forces[0]->dead_loads();
  ASSERT_EQ(loads.size(), 6U + 12U);
  EXPECT_EQ(dead_loads(forces).size(), loads.size());
  const Added added(*forces[0], surface.masses);
  for (std::size_t n = 0; n < 12; ++n) {
    const NodalLoad& load = loads[6 + n];
    EXPECT_EQ(load.node, static_cast<int>(n));
    EXPECT_EQ(load.curve, 1U);
    Vector sum{};
    for (std::size_t i = 0; i < 3; ++i) {
      EXPECT_EQ(load.force[i], surface.masses[n] * weight[i]);
      for (const NodalLoad& one : loads)
        sum[i] += one.node == load.node ? largest_factor * one.force[i] : 0.0;
    }
    expect_force(added.forces[n], sum, n);
    EXPECT_EQ(added.rates[n].square, 0.0);
  }
  EXPECT_NEAR(added.size, 5.0 + 13.0 / 10.0 + 1.0 * 78.0, 1e-12);
  EXPECT_TRUE(forces[0]->traits().drives);
}

/// Equal curves share a number; number 0 is the curve of the case.
TEST(Force, curves_are_numbered) {
  Surface surface;
  const LoadCurve table{{0.0, 1.0}, {0.0, 2.0}}, other{{0.0, 1.0}, {0.0, 3.0}};
  EXPECT_EQ(surface.resolver.number_of({}), 0U);
  EXPECT_EQ(surface.resolver.number_of(table), 1U);
  EXPECT_EQ(surface.resolver.number_of(other), 2U);
  EXPECT_EQ(surface.resolver.number_of(table), 1U);
  EXPECT_EQ(surface.resolver.curves, (std::vector<LoadCurve>{{}, table, other}));
}

/// A force on a part of the mesh equals the force on the part's faces and nodes; where it does not act, there
/// is none.
TEST(Force, acts_on_a_part_as_on_its_faces_alone) {
  Surface surface;
  const MeshPart part = part_of_mesh(surface.mesh, {false, true}),
                 none = part_of_mesh(surface.mesh, {false, false});
  std::vector<double> masses;
  for (const int node : part.node_of) masses.push_back(surface.masses[at(node)]);
  NodeSets alone{{"surface", {}}};
  for (const int node : surface.sets["surface"]) {
    if (part.part_of[at(node)] >= 0) alone["surface"].push_back(part.part_of[at(node)]);
  }
  const auto boundary = boundary_faces(part.mesh.cells);
  ForceResolver there{"a.toml", part.mesh.points, boundary, alone, masses};
  const auto compare = [&](const auto& kind) {
    const auto restricted = surface.made(kind)->restricted_to(part);
    kind.resolve(there);
    const Vector u{0.1, 0.2, 0.3};
    const Added left(*restricted, masses, u, u, 1.0), right(*there.all().back(), masses, u, u, 1.0);
    for (std::size_t n = 0; n < masses.size(); ++n) {
      expect_force(left.forces[n], {right.forces[n][0], right.forces[n][1], right.forces[n][2]}, n);
      EXPECT_EQ(left.rates[n].square, right.rates[n].square);
    }
    EXPECT_EQ(surface.resolver.all().back()->restricted_to(none), nullptr);
  };
  compare(Gravity{{1.0, 2.0, 3.0}});
  compare(Pressure{"surface", 7.0});
  compare(Support{"surface", 11.0, 0.5, false});
}

}  // namespace
}  // namespace sandglass::verification::force_test
