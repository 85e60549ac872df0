/// Meshes with hanging nodes: no cracks, no duplicate boundary, and every property of a conforming mesh.

#include "mesh/refinement.hpp"

#include <gtest/gtest.h>

#include <set>

#include "base/error.hpp"
#include "mesh/quality.hpp"
#include "solve/body.hpp"
#include "solve/central_difference.hpp"
#include "solve/relaxation.hpp"
#include "support/exact_fields.hpp"
#include "support/manufactured.hpp"
#include "support/method_test.hpp"

namespace sandglass::verification::refinement_test {
namespace {

constexpr double eps = std::numeric_limits<double>::epsilon();

/// A scene on a refined mesh, held as described, with the sets of the refined mesh.
Scene scene_on(const RefinedMesh& refined, const Case& description, const NodeSets& sets) {
  Scene scene = make_scene(description, refined.mesh(), sets);
  scene.ties = to_free_nodes(refined.ties());
  scene.coarser = refined.coarser();
  scene.boundary = refined.boundary();
  std::erase_if(scene.constraints, [&](const Constraint& c) { return is_tied(scene.ties, c.node); });
  return scene;
}

/// Splits each element with a probability, `depth` times.
RefinedMesh randomly_refined(const Mesh& mesh, int depth, std::uint64_t seed, double probability = 0.3) {
  RefinedMesh refined(mesh);
  RandomGeometry random(seed);
  for (int d = 0; d < depth; ++d) {
    std::vector<bool> marked;
    for (std::size_t e = 0; e < refined.mesh().cells.size(); ++e)
      marked.push_back(random.uniform(0.0, 1.0) < probability);
    refined.split(std::move(marked));
  }
  return refined;
}

double volume(const Mesh& mesh) {
  double sum = 0.0;
  for (const auto& cell : mesh.cells) sum += mean_gradient(gather(mesh.points, cell)).volume;
  return sum;
}

Vector area(const NodalField& points, const std::vector<Quadrilateral>& faces) {
  Vector sum{};
  for (const auto& face : faces) {
    for (const auto& point : gauss_points_of(corners_of(points, face))) sum[0] += point.area;
  }
  return sum;
}

/// Calls use(refined) for every choice of elements to split in a cube of eight; for every eighth of them once
/// more with random further splits.
template <class Use>
void for_each_choice(const Use& use) {
  for (int choice = 1; choice < 256; ++choice) {
    RefinedMesh refined(distorted_cube(2, 0.15, 7));
    std::vector<bool> marked;
    for (int e = 0; e < 8; ++e) marked.push_back((choice >> e & 1) != 0);
    refined.split(std::move(marked));
    use(refined);
    if (choice % 8 != 0) continue;
    RandomGeometry random(static_cast<std::uint64_t>(choice));
    std::vector<bool> again;
    for (std::size_t e = 0; e < refined.mesh().cells.size(); ++e)
      again.push_back(random.uniform(0.0, 1.0) < 0.1);
    refined.split(std::move(again));
    use(refined);
  }
}

/// Parts fill their elements, and only faces of the body are boundary: volume and surface stay the same.
TEST(RefinedMesh, keeps_volume_and_surface) {
  const Mesh mesh = distorted_cube(2, 0.15, 7);
  const double V = volume(mesh), A = area(mesh.points, boundary_faces(mesh.cells))[0];
  for_each_choice([&](const RefinedMesh& refined) {
    require_positive_jacobians(refined.mesh());
    EXPECT_NEAR(volume(refined.mesh()), V, 64 * eps * V);
    EXPECT_NEAR(area(refined.mesh().points, refined.boundary())[0], A, 1e-12 * A);
  });
}

/// Elements that share a node, or part of an edge or a face, differ by at most one split.
TEST(RefinedMesh, neighbours_differ_by_one_split) {
  for (std::uint64_t seed = 1; seed < 6; ++seed) {
    const RefinedMesh refined = randomly_refined(box({1, 1, 1}, {2, 2, 2}), 3, seed, 0.2);
    EXPECT_EQ(*std::max_element(refined.splits().begin(), refined.splits().end()), 3);
    const auto& [points, cells] = refined.mesh();
    std::vector<std::array<Vector, 2>> boxes;
    for (const auto& cell : cells) {
      NodalField corners;
      for (const int n : cell) corners.push_back(points[index(n)]);
      boxes.push_back(bounding_box(corners));
    }
    for (std::size_t a = 0; a < cells.size(); ++a) {
      for (std::size_t b = 0; b < a; ++b) {
        bool touch = true;
        for (std::size_t i = 0; i < 3; ++i)
          touch = touch && boxes[a][0][i] < boxes[b][1][i] + 1e-9 && boxes[b][0][i] < boxes[a][1][i] + 1e-9;
        if (touch) {
          EXPECT_LE(std::abs(refined.splits()[a] - refined.splits()[b]), 1);
        }
      }
    }
  }
}

/// A linear field is continuous: each tied node has its value, and each node on an edge or a face of a larger
/// element is tied.
TEST(RefinedMesh, ties_reproduce_linear_fields_and_leave_no_crack) {
  const Tensor<double> H{{.1, .2, -.3, .4, .5, .6, -.7, .8, .9}};
  for_each_choice([&](const RefinedMesh& refined) {
    NodalField u;
    for (const Vector& X : refined.mesh().points) u.push_back(linear(H, X));
    const NodalField exact = u;
    const Ties ties = to_free_nodes(refined.ties());
    for (const Tie& tie : ties) {
      u[index(tie.node)] = {};
      double sum = 0.0;
      for (const auto& [node, weight] : tie.mean_of) {
        EXPECT_FALSE(is_tied(ties, node));
        EXPECT_GT(weight, 0.0);
        sum += weight;
      }
      EXPECT_NEAR(sum, 1.0, 8 * eps);
    }
    follow(ties, u);
    EXPECT_LT(largest_distance(u, exact), 32 * eps);
    // A hanging node without a tie would show in the number of inner faces around it: every face must be on
    // the boundary, shared by two elements, or part of a face whose middle is tied.
    std::set<int> middles;
    for (const Tie& tie : refined.ties())
      if (tie.mean_of.size() == 4) middles.insert(tie.node);
    const std::size_t single = boundary_faces(refined.mesh().cells).size();
    EXPECT_EQ(single, refined.boundary().size() + 5 * middles.size());  // a large face and its four parts
  });
}

/// New nodes are in a set if all corners around them are.
TEST(RefinedMesh, sets_pass_on_to_parts) {
  const Mesh mesh = box({1, 1, 1}, {2, 2, 2});
  const RefinedMesh refined = randomly_refined(mesh, 2, 3, 0.5);
  const auto top = [](const Vector& X) { return X[2] == 1.0; };
  EXPECT_EQ(refined.nodes_of(nodes_where(mesh.points, top)), nodes_where(refined.mesh().points, top));
  const auto parts = refined.elements_of({3});
  double sum = 0.0;
  for (const int e : parts) {
    const auto& cell = refined.mesh().cells[index(e)];
    EXPECT_GT(mean_at(cell, refined.mesh().points)[0], 0.5);
    sum += mean_gradient(gather(refined.mesh().points, cell)).volume;
  }
  EXPECT_NEAR(sum, 0.125, 16 * eps);
}

TEST(Ties, in_a_circle_are_refused) {
  EXPECT_THROW(to_free_nodes({{1, {{2, 1.0}}}, {2, {{1, 1.0}}}}), InputError);
}

/// Free forces (N) of a model at displacements u, reached from the undeformed shape in one step.
NodalField free_forces(const Model& model, const NodalField& u) {
  const auto& elements = *std::get<std::unique_ptr<InternalForce<double>>>(model.internal_force());
  Body<double> body(model, elements);
  body.state() = state_at(elements, u);
  body.evaluate_forces();
  return body.field(body.free_forces());
}

double largest(const NodalField& field) {
  return largest_distance(field, NodalField(field.size()));
}

const NeoHookean soft{.young_modulus = 3000.0, .poisson_ratio = 0.45};

class RefinedBodyTest : public MethodTest {};
INSTANTIATE_TEST_SUITE_P(, RefinedBodyTest, each_of(MovingMethods{}), method_label);

/// Under a linear field stresses are constant, and forces on inner nodes vanish once tied nodes pass theirs
/// on: the patch test with hanging nodes in all positions. Forces are sums of stresses times areas; their
/// rounding is that of stresses of the size of K.
TEST_P(RefinedBodyTest, passes_the_patch_test) {
  const Tensor<double> H{{.02, .05, -.03, .04, -.03, .02, -.05, .01, .02}};
  for_each_choice([&](const RefinedMesh& refined) {
    Case description = plain_case(soft);
    const NodeSets sets{{"surface", nodes_where(refined.mesh().points, [](const Vector& X) {
                           return std::ranges::any_of(X, [](double x) { return x == 0.0 || x == 1.0; });
                         })}};
    description.displacements = {{"surface", {}}};
    const Scene scene = scene_on(refined, description, sets);
    NodalField u;
    for (const Vector& X : refined.mesh().points) u.push_back(linear(H, X));
    const NodalField forces = free_forces(Model(scene, choice()), u);
    EXPECT_LT(largest(forces), 1e3 * eps * soft.bulk_modulus());
  });
}

/// Translations and, unless the method is linear, rotations cause no forces.
TEST_P(RefinedBodyTest, knows_rigid_motions) {
  const RefinedMesh refined = randomly_refined(distorted_cube(2, 0.15, 3), 2, 4);
  const Scene scene = scene_on(refined, plain_case(soft), {});
  const Model model(scene, choice());
  RandomGeometry random(5);
  Tensor<double> H{};
  if (!method.is_linear && is_path_independent(method)) H = random.rotation() - identity<double>();
  NodalField u;
  for (const Vector& X : refined.mesh().points) {
    u.push_back(linear(H, X));
    u.back()[0] += 0.3;
  }
  EXPECT_LT(largest(free_forces(model, u)), 1e4 * eps * soft.bulk_modulus());
}

/// The free forces are the derivative of the energy by the displacements of the free nodes, which tied nodes
/// follow.
TEST_P(RefinedBodyTest, forces_are_the_derivative_of_the_energy) {
  if (!is_path_independent(method)) GTEST_SKIP() << "its forces depend on the path";
  const RefinedMesh refined = randomly_refined(distorted_cube(2, 0.15, 3), 2, 4);
  const Scene scene = scene_on(refined, plain_case(soft), {});
  const Model model(scene, choice());
  RandomGeometry random(6);
  const std::size_t nodes = refined.mesh().points.size();
  const auto followed = [&](double size) {
    NodalField field(nodes);
    for (Vector& v : field)
      v = {random.uniform(-size, size), random.uniform(-size, size), random.uniform(-size, size)};
    follow(scene.ties, field);
    return field;
  };
  const NodalField u = followed(0.02), d = followed(1.0), f = free_forces(model, u);
  const auto energy = [&](double step) {
    NodalField moved = u;
    for (std::size_t n = 0; n < nodes; ++n)
      for (std::size_t i = 0; i < 3; ++i) moved[n][i] += step * d[n][i];
    const StrainEnergies energies = strain_energies(model, moved);
    return energies.strain + energies.hourglass;
  };
  double slope = 0.0, size = 0.0;
  for (std::size_t n = 0; n < nodes; ++n) {
    if (is_tied(scene.ties, static_cast<int>(n))) {
      EXPECT_EQ(length(f[n]), 0.0);
      continue;
    }
    for (std::size_t i = 0; i < 3; ++i) {
      slope += f[n][i] * d[n][i];
      size += std::abs(f[n][i] * d[n][i]);
    }
  }
  // The error of the difference, (step / element size)^2 / 6 of a third derivative that is as large as the
  // forces.
  const double step = 1e-5;
  EXPECT_NEAR((energy(step) - energy(-step)) / (2 * step), slope, 1e-6 * size);
}

/// A free body that flies, spins and vibrates: momentum up to rounding, angular momentum and energy up to an
/// oscillation of (omega dt)^2, without drift. Tied nodes have no mass of their own; the nodes that they
/// follow carry all of it.
TEST_P(RefinedBodyTest, keeps_momentum_and_energy_in_motion) {
  if (!is_path_independent(method)) GTEST_SKIP() << "it dissipates, or its energy depends on the path";
  const RefinedMesh refined = randomly_refined(distorted_cube(2, 0.15, 3), 2, 4);
  Case description = plain_case(soft);
  description.quasi_static = false;
  description.velocities = {{.value = {0.3, 0.1, 0.0}},
                            {.value = {0.0, 0.2, 0.1}, .half_waves = {1, 0, 1}},
                            {.spin = {0.0, 0.0, method.is_linear ? 0.0 : 0.5}}};
  description.dynamics.duration = 0.5;
  description.dynamics.step_fraction = 0.4;
  description.dynamics.check_interval = 10;
  description.dynamics.frames = 10;
  const Scene scene = scene_on(refined, description, {});
  const Model model(scene, choice());
  double mass = 0.0;
  for (const double m : model.masses()) mass += m;
  EXPECT_NEAR(mass, 1000.0, 1e-9);
  Recorder recorder;
  integrate(model, recorder);
  const auto momenta = [&](const Frame& frame) {
    std::array<Vector, 2> sum{};
    for (std::size_t n = 0; n < frame.u.size(); ++n) {
      const double m = model.masses()[n];
      Vector x = refined.mesh().points[n];
      for (std::size_t i = 0; i < 3; ++i) x[i] += frame.u[n][i];
      for (std::size_t i = 0; i < 3; ++i) {
        const std::size_t j = (i + 1) % 3, k = (i + 2) % 3;
        sum[0][i] += m * frame.v[n][i];
        sum[1][i] += m * (x[j] * frame.v[n][k] - x[k] * frame.v[n][j]);
      }
    }
    return sum;
  };
  const auto [p, L] = momenta(recorder.frames.front());
  ASSERT_GT(recorder.frames.size(), 5U);
  for (const Frame& frame : recorder.frames) {
    const auto [now, turning] = momenta(frame);
    EXPECT_LT(distance(now, p), 1e-11 * length(p));
    if (!method.is_linear) {
      EXPECT_LT(distance(turning, L), 2e-3 * length(L));
    }
  }
  const double start = total_energy(recorder.rows.front());
  for (const HistoryRow& row : recorder.rows) EXPECT_NEAR(total_energy(row), start, 0.02 * start);
}

/// On randomly refined meshes, errors of displacements fall with the square of the edge: manufactured waves,
/// five faces imposed, tractions on the sixth.
TEST_P(RefinedBodyTest, converges_with_second_order) {
  if (leaves_hourglass_modes(choice()) || method.adapts()) GTEST_SKIP() << "no answer of its own";
  const WaveField field{};
  const ManufacturedSolution<WaveField> solution{field, soft, method.is_linear};
  const auto error = [&](int n) {
    const RefinedMesh refined = randomly_refined(distorted_cube(n, 0.1, 8), 1, 9, 0.2);
    const Mesh& mesh = refined.mesh();
    const auto held = nodes_where(mesh.points, [&](const Vector& X) {
      const bool inside_the_loaded_face = X[0] == 1.0 && X[1] > 0.0 && X[1] < 1.0 && X[2] > 0.0 && X[2] < 1.0;
      return !inside_the_loaded_face && std::ranges::any_of(X, [](double x) { return x == 0.0 || x == 1.0; });
    });
    Case description = plain_case(soft);
    NodeSets sets;
    impose_field(
        held, mesh.points, [&](const Vector& X) { return solution.displacement(X); }, description, sets);
    Scene scene = scene_on(refined, description, sets);
    scene.forces = {std::make_shared<DeadLoads>(manufactured_loads(mesh, solution))};
    Observer silent;
    const Relaxation answer = relax(Model(scene, choice()), silent);
    EXPECT_TRUE(answer.converged) << outcome(answer, Precision::double_precision);
    return field_errors(mesh, answer.u, field).displacement;
  };
  EXPECT_NEAR(std::log2(error(4) / error(8)), 2.0, 0.25);
}

}  // namespace
}  // namespace sandglass::verification::refinement_test
