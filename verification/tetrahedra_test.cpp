/// Tetrahedra against a second implementation with nodes only: both splits of a hexahedron by hand, and
/// averaged nodal pressures summed over a mesh.

#include <gtest/gtest.h>

#include "base/error.hpp"
#include "counting/operation_count.hpp"
#include "solve/relaxation.hpp"
#include "solve/stable_step.hpp"
#include "support/dense_matrix.hpp"
#include "support/derivatives.hpp"
#include "support/fitting_elements.hpp"
#include "support/patch_mesh.hpp"
#include "support/path.hpp"
#include "support/typed_lists.hpp"

namespace sandglass::verification::tetrahedra_test {
namespace {

constexpr double eps = std::numeric_limits<double>::epsilon();

/// Both splits of a hexahedron in VTK order into five: four corners and the rest, twice.
constexpr int cuts[10][4] = {{1, 2, 0, 5}, {3, 0, 2, 7}, {4, 5, 0, 7}, {6, 7, 2, 5}, {0, 2, 5, 7},
                             {0, 1, 3, 4}, {2, 3, 1, 6}, {5, 6, 1, 4}, {7, 4, 3, 6}, {1, 3, 4, 6}};

/// The columns b - a, c - a, d - a.
template <class T>
Tensor<T> edges(const std::vector<Triple<T>>& x, const Hexahedron& cell, const int (&corners)[4]) {
  Tensor<T> columns;
  for (int k = 0; k < 3; ++k) {
    const auto& from = x[index(cell[index(corners[0])])];
    const auto& to = x[index(cell[index(corners[k + 1])])];
    for (int i = 0; i < 3; ++i) columns(i, k) = to(i, 0) - from(i, 0);
  }
  return columns;
}

template <class T>
std::vector<Triple<T>> triples(const NodalField& field) {
  std::vector<Triple<T>> result;
  for (const Vector& a : field) result.push_back({{T(a[0]), T(a[1]), T(a[2])}});
  return result;
}

/// sum_e V_e W_iso + sum_I V_I U(J_I) with averaged pressures, sum_e V_e W without, from the definitions.
template <class T, class Law>
T energy_by_hand(const Mesh& mesh, const Law& law, const std::vector<Triple<T>>& u, bool averaged) {
  const auto X = triples<T>(mesh.points);
  std::vector<T> volume(X.size(), T(0.0)), change(X.size(), T(0.0));
  T W(0.0);
  for (const Hexahedron& cell : mesh.cells) {
    for (const auto& corners : cuts) {
      const Tensor<T> D = edges(X, cell, corners);
      const T V = abs(determinant(D)) * T(0.5 / 6.0);
      const Tensor<T> H = edges(u, cell, corners) * inverse(D);
      const T dilatation = jacobian_minus_one(H);
      W = W + V * law.isochoric_energy(H);
      if (!averaged) W = W + V * law.volumetric_energy(dilatation);
      for (const int a : corners) {
        const std::size_t I = index(cell[index(a)]);
        volume[I] = volume[I] + T(0.25) * V;
        change[I] = change[I] + T(0.25) * V * dilatation;
      }
    }
  }
  for (std::size_t I = 0; averaged && I < volume.size(); ++I) {
    W = W + volume[I] * law.volumetric_energy(change[I] / volume[I]);
  }
  return W;
}

/// Exact derivatives of this energy.
template <class Law>
NodalField forces_by_hand(const Mesh& mesh, const Law& law, const NodalField& u, bool averaged) {
  auto dual = triples<D>(u);
  NodalField f(u.size());
  for (std::size_t n = 0; n < u.size(); ++n) {
    for (std::size_t i = 0; i < 3; ++i) {
      const int row = static_cast<int>(i);
      dual[n](row, 0).slope = 1.0;
      f[n][i] = energy_by_hand(mesh, law, dual, averaged).slope;
      dual[n](row, 0).slope = 0.0;
    }
  }
  return f;
}

/// The patch of MacNeal and Harder, and a box whose inner nodes and sides are displaced.
std::vector<Mesh> distorted_meshes() {
  Mesh distorted = box({2, 3, 2}, {2, 3, 2});
  RandomGeometry random(5);
  for (auto& X : distorted.points) {
    for (double& x : X) x += random.uniform(-0.12, 0.12);
  }
  return {fitting_patch("t4"), distorted};
}

struct Method {
  const char* name;
  bool averaged;
};
constexpr Method methods[] = {{"t4", false}, {"t4-anp", true}};

Scene scene_of(const Mesh& mesh, const NeoHookean& law) {
  return make_scene(plain_case(law), mesh);
}

/// A large deformation plus a wave, without inverted tetrahedra.
NodalField displacements(const Model& model, RandomGeometry& random) {
  const Mesh& mesh = model.scene().mesh;
  const auto& elements = *std::get<0>(model.internal_force());
  const double size = std::cbrt(mean_gradient(gather(mesh.points, mesh.cells.front())).volume);
  std::vector<double> jacobians(mesh.cells.size());
  NodalField u;
  do {
    const Tensor<double> H = random.deformation(0.8, 1.3) - identity<double>();
    u.clear();
    for (const Vector& X : mesh.points) {
      u.push_back(linear(H, X));
      for (double& x : u.back()) x += 0.05 * size * random.uniform(-1, 1);
    }
    elements.smallest_jacobians(state_at(elements, u), jacobians);
  } while (*std::ranges::min_element(jacobians) < 0.1);
  return u;
}

/// Roundoff of the forces on a mesh: displacements and coordinates are rounded by eps of the largest, and the
/// largest stiffness turns that into force; summed over the eight elements at a node.
double roundoff(const Model& model, const NodalField& u) {
  std::vector<double> bounds(model.scene().mesh.cells.size());
  const auto& elements = *std::get<0>(model.internal_force());
  elements.stiffness_bounds(state_at(elements, u), bounds);
  double largest = 0.0;
  for (const auto* field : {&u, &model.scene().mesh.points}) {
    for (const Vector& a : *field)
      largest = std::max({largest, std::abs(a[0]), std::abs(a[1]), std::abs(a[2])});
  }
  return 8 * 32 * eps * largest * *std::ranges::max_element(bounds);
}

/// Energies and forces of whole meshes follow the definition; the forces are its derivative.
TEST(TetrahedraTest, energies_and_forces_of_a_mesh_are_those_of_the_definition) {
  RandomGeometry random(31);
  for (const Mesh& mesh : distorted_meshes()) {
    for (const double nu : poisson_ratios) {
      const auto law = sample_law<NeoHookean>(nu);
      const Scene scene = scene_of(mesh, law);
      for (const auto& [name, averaged] : methods) {
        const Model model(scene, {name});
        const NodalField u = displacements(model, random);
        const double W = energy_by_hand(mesh, law, triples<double>(u), averaged);
        EXPECT_NEAR(strain_energies(model, u).strain / W, 1.0, 1e-12) << name;
        const NodalField exact = forces_by_hand(mesh, law, u, averaged);
        Path path(mesh, law, {name});
        path.to(displacements(model, random));  // no trace of which may stay
        EXPECT_LT(largest_distance(path.to(u), exact), roundoff(model, u)) << name;
      }
      // Samples that distinguish the two methods.
      const Model own(scene, {"t4"}), averaged(scene, {"t4-anp"});
      const NodalField u = displacements(own, random);
      EXPECT_GT(largest_distance(internal_forces(averaged, u), internal_forces(own, u)),
                1e6 * roundoff(averaged, u));
    }
  }
}

/// A unit cube of which only the corner at the origin moves, by a along x, and the volumetric part of the
/// force on it. J = 1 + a dN/dx: 1 - a in its own tetrahedron and that of its neighbour along x, 1 in those
/// of its neighbours along y and z, 1 - a/2 in the inner one; half volumes are 1/12, and 1/6 inside. So a/12
/// of volume is lost three times. Own pressures: f = K a (1/12 + 1/12 + 1/24) = 5/24 K a. Averaged: 1/8 of
/// volume at each node loses a/12 c/4, where c of the three are the node's: c = 3 at the corner, 2 2 2 and 1
/// 1 1 elsewhere, 0 at the opposite one, so that J_I - 1 = -c a/6 and f = sum 1/8 K c^2 a/36 = 24/288 K a.
TEST(TetrahedraTest, one_corner_moved_by_hand) {
  const double a = 0.3;
  const double mu = 100.0;
  NodalField u(8);
  u[0] = {a, 0, 0};
  const auto force = [&](const char* method, double K) {
    const double E = 9 * K * mu / (3 * K + mu);
    const NeoHookean law{.young_modulus = E, .poisson_ratio = E / (2 * mu) - 1};
    const Scene scene = scene_of(box({1, 1, 1}, {1, 1, 1}), law);
    return internal_forces(Model(scene, {method}), u)[0][0];
  };
  // Laws with the same shear modulus differ only in the volumetric part.
  EXPECT_NEAR(force("t4", 2000.0) - force("t4", 1000.0), 1000.0 * a * 5 / 24, 1e-10);
  EXPECT_NEAR(force("t4-anp", 2000.0) - force("t4-anp", 1000.0), 1000.0 * a / 12, 1e-10);
}

/// Rigid motion of a whole mesh causes no force; turning a deformed one turns the forces.
TEST(TetrahedraTest, forces_turn_with_the_mesh) {
  RandomGeometry random(32);
  const auto law = sample_law<NeoHookean>(0.499);
  for (const Mesh& mesh : distorted_meshes()) {
    const Scene scene = scene_of(mesh, law);
    const Model model(scene, {"t4-anp"});
    const Tensor<double> Q = random.rotation();
    const NodalField u = displacements(model, random);
    NodalField rigid, turned;
    for (std::size_t n = 0; n < u.size(); ++n) {
      const Vector X = mesh.points[n];
      rigid.push_back(linear(Q - identity<double>(), X));
      const Vector x = linear(Q, {X[0] + u[n][0], X[1] + u[n][1], X[2] + u[n][2]});
      turned.push_back({x[0] - X[0], x[1] - X[1], x[2] - X[2]});
    }
    const NodalField none(u.size());
    EXPECT_LT(largest_distance(internal_forces(model, rigid), none), roundoff(model, rigid));
    NodalField expected = internal_forces(model, u);
    for (auto& f : expected) f = linear(Q, f);
    EXPECT_LT(largest_distance(internal_forces(model, turned), expected), roundoff(model, turned));
  }
}

/// The largest eigenvalue of M^-1 K of a whole mesh, 1/s^2: K by central differences of the forces over 1e-5
/// of an element, which have an error of 1e-10 of K.
double largest_frequency_square(const Model& model, NodalField u) {
  const std::size_t size = 3 * u.size();
  const double h = 1e-5 * std::cbrt(model.element_masses()[0] / model.scene().materials.list.front().density);
  std::vector<double> K(size * size);
  for (std::size_t n = 0; n < size; ++n) {
    double& x = u[n / 3][n % 3];
    const double at = x;
    x = at + h;
    const NodalField up = internal_forces(model, u);
    x = at - h;
    const NodalField down = internal_forces(model, u);
    x = at;
    for (std::size_t m = 0; m < size; ++m) {
      const double mass = std::sqrt(model.masses()[n / 3] * model.masses()[m / 3]);
      K[n * size + m] = (up[m / 3][m % 3] - down[m / 3][m % 3]) / (2 * h * mass);
    }
  }
  return symmetric_eigenvalues(K).back();
}

/// Nodal pressures couple all elements around a node: no element has a tangent of its own, but the step from
/// the elements' bounds is safe for the whole mesh. On boxes it is also efficient: at least 0.4 of the true
/// limit. (Where an element is much flatter than the neighbours that share the mass of its nodes, no bound
/// from single elements is close.)
TEST(TetrahedraTest, stable_step_holds_for_the_assembled_mesh) {
  RandomGeometry random(33);
  auto meshes = distorted_meshes();
  const std::size_t boxes_from = 1;
  meshes.push_back(box({2, 2, 2}, {2, 2, 2}));
  meshes.push_back(box({3, 1, 1}, {3, 1, 1}));
  for (std::size_t n = 0; n < meshes.size(); ++n) {
    for (const double nu : poisson_ratios) {
      const Scene scene = scene_of(meshes[n], sample_law<NeoHookean>(nu));
      for (const auto& [name, averaged] : methods) {
        const Model model(scene, {name});
        for (const NodalField& u : {NodalField(meshes[n].points.size()), displacements(model, random)}) {
          const double truth = 2.0 / std::sqrt(largest_frequency_square(model, u));
          const double step = stable_step(model, u).step;
          EXPECT_LE(step, truth * (1 + 1e-8)) << name << " nu " << nu;
          if (n >= boxes_from) {
            EXPECT_GE(step, 0.4 * truth) << name << " nu " << nu;
          }
        }
      }
    }
  }
}

/// Bending stiffness (N) of a cantilever n elements thick: the reaction to a small displacement of its tip.
double tip_force(const char* method, double nu, int n) {
  Case description = plain_case(sample_law<NeoHookean>(nu));
  const Mesh mesh = box({4, 1, 1}, {4 * n, n, n});
  const NodeSets sets{{"foot", nodes_where(mesh.points, [](const Vector& X) { return X[0] == 0.0; })},
                      {"tip", nodes_where(mesh.points, [](const Vector& X) { return X[0] == 4.0; })}};
  const double d = 0.01;
  description.displacements = {{"foot", {}}, {"tip", {0, 0, d}}};
  const Scene scene = make_scene(description, mesh, sets);
  const Model model(scene, {method});
  Observer silent;
  const Relaxation answer = relax(model, silent);
  EXPECT_TRUE(answer.converged) << method;
  const NodalField force = internal_forces(model, answer.u);
  double sum = 0.0;
  for (const int tip : sets.at("tip")) sum += force[index(tip)][2];
  return sum / d;
}

/// Nearly incompressible, twice as many elements: an element without volumetric locking divides its excess
/// stiffness by 4; linear tetrahedra hardly reduce theirs, since each keeps its own volume. Orders of
/// convergence of 1.5 and 0.25 lie between the two. The reference has an error of a few percent of itself,
/// while t4-anp is 80 % and 23 % above it. A hundredfold bulk modulus changes t4-anp by less than a percent,
/// the remaining influence of K/mu in the continuum.
TEST(TetrahedraTest, averaged_pressures_cure_volumetric_locking) {
  const double nu = 0.4999;
  const double reference = tip_force("tl-mean-dilatation", nu, 8);
  const auto excess = [&](const char* method, int n) { return tip_force(method, nu, n) / reference - 1.0; };
  EXPECT_LT(excess("t4-anp", 4), std::pow(0.5, 1.5) * excess("t4-anp", 2));
  EXPECT_GT(excess("t4", 4), std::pow(0.5, 0.25) * excess("t4", 2));
  EXPECT_GT(excess("t4", 4), 3.0);
  EXPECT_NEAR(tip_force("t4-anp", nu, 4) / tip_force("t4-anp", 0.49, 4), 1.0, 0.05);
}

/// The operations of averaging, by hand. First pass: 15 additions per component for the modes, 24 for the
/// corners' gradients, 6 for the inner ones; ten products of 27 and 18 operations, ten determinants of 15 and
/// 14; weights; two sums over five tetrahedra for each of eight nodes, and their quarters; four nodes' sums
/// with the element before, and four divisions. Second pass: eight pressures, not ten, their quarters and ten
/// sums of four.
TEST(TetrahedraTest, operations_of_two_passes_by_hand) {
  const auto law = sample_law<NeoHookean>(0.49);
  const auto own = count_operations<T4::Kinematics, T4::Hourglass>(law);
  const auto averaged = count_operations<T4Anp::Kinematics, T4Anp::Hourglass>(law);
  const Operations extra = averaged.total - own.total;
  EXPECT_EQ(extra.add, 3 * (15 + 24 + 6) + 10 * (18 + 14) + 2 * 8 * 4 + 2 * 4 + 10 * 3);
  EXPECT_EQ(extra.mul, 10 * (27 + 15) + 10 + 2 * 8 + (8 - 10) + 8);
  EXPECT_EQ(extra.div, 4);
  EXPECT_EQ(extra.special, 0);
  EXPECT_EQ(averaged.bytes, 2 * own.bytes);
}

/// A hexahedron with valid Gauss points may have an inverted corner, which tetrahedra reject by name.
TEST(TetrahedraTest, corners_without_volume_are_refused) {
  const Mesh mesh = macneal_harder_patch();
  const auto law = sample_law<NeoHookean>(0.49);
  EXPECT_NO_THROW(make_internal_force(mesh, law, {"tl-full"}));
  for (const auto& [name, averaged] : methods) {
    try {
      make_internal_force(mesh, law, {name});
      FAIL() << name;
    } catch (const InputError& error) {
      EXPECT_NE(std::string(error.what()).find("(0.509, 0.140125, 0.47575)"), std::string::npos);
    }
  }
}

}  // namespace
}  // namespace sandglass::verification::tetrahedra_test
