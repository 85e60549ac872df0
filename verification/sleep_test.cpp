/// Sleeping parts of bodies: exact distances, parts of meshes, and neglected motions within the bound.

#include "solve/sleep.hpp"

#include <gtest/gtest.h>

#include "base/error.hpp"
#include "mesh/distances.hpp"
#include "mesh/mesh_part.hpp"
#include "support/scenes.hpp"
#include "support/typed_lists.hpp"

namespace sandglass::verification::sleep_test {
namespace {

std::size_t count(const std::vector<bool>& marked) {
  return static_cast<std::size_t>(std::count(marked.begin(), marked.end(), true));
}

/// In a lattice the distance, corner to corner, is the largest of the three differences.
TEST(Distances, count_elements_corner_to_corner) {
  const Mesh mesh = box({5, 4, 3}, {5, 4, 3});
  const Vector from{1, 4, 2};
  const auto distance =
      Distances(mesh).from(nodes_where(mesh.points, [&](const Vector& X) { return X == from; }));
  for (std::size_t n = 0; n < mesh.points.size(); ++n) {
    double expected = 0.0;
    for (std::size_t i = 0; i < 3; ++i) {
      expected = std::max(expected, std::abs(mesh.points[n][i] - from[i]));
    }
    EXPECT_EQ(distance[n], static_cast<int>(expected));
  }
}

TEST(Distances, unreachable_nodes_are_marked) {
  Mesh mesh = box({2, 1, 1}, {2, 1, 1});
  mesh.cells.pop_back();
  const auto distance = Distances(mesh).from({mesh.cells[0][0]});
  EXPECT_EQ(std::count(distance.begin(), distance.end(), -1), 4);
}

/// A margin of m around an inner node of a lattice marks a cube of 2 m elements per edge, around two nodes
/// the union; where two margins meet, the larger one extends further.
TEST(Distances, margins_mark_cubes) {
  const Mesh mesh = box({8, 8, 8}, {8, 8, 8});
  const Distances distances(mesh);
  const auto node = [&](double x, double y, double z) {
    return index(nodes_where(mesh.points, [&](const Vector& X) { return X == Vector{x, y, z}; }).front());
  };
  std::vector<int> margin(mesh.points.size(), 0);
  const auto marked = [&] {
    std::vector<bool> marks(mesh.cells.size(), false);
    distances.mark(margin, marks);
    return count(marks);
  };
  EXPECT_EQ(marked(), 0U);
  margin[node(4, 4, 4)] = 1;
  EXPECT_EQ(marked(), 8U);
  margin[node(4, 4, 4)] = 3;
  EXPECT_EQ(marked(), 216U);
  margin[node(0, 0, 0)] = 1;
  EXPECT_EQ(marked(), 217U);
  margin[node(4, 4, 5)] = 2;  // inside the larger one
  EXPECT_EQ(marked(), 217U);
  margin[node(4, 4, 7)] = 2;  // one new layer of 4 x 4 elements
  EXPECT_EQ(marked(), 217U + 16U);
}

TEST(MeshPart, half_of_a_box) {
  const Mesh mesh = box({4, 2, 2}, {4, 2, 2});
  std::vector<bool> marked(mesh.cells.size());
  for (std::size_t e = 0; e < marked.size(); ++e) {
    marked[e] = gather(mesh.points, mesh.cells[e])(0, 0) >= 2.0;
  }
  const MeshPart part = part_of_mesh(mesh, marked);
  EXPECT_EQ(part.mesh.cells.size(), 8U);
  ASSERT_EQ(part.mesh.points.size(), 27U);
  for (std::size_t n = 0; n < part.mesh.points.size(); ++n) {
    EXPECT_EQ(part.mesh.points[n], mesh.points[index(part.node_of[n])]);
    EXPECT_EQ(part.part_of[index(part.node_of[n])], static_cast<int>(n));
    EXPECT_EQ(part.on_the_rim[n], part.mesh.points[n][0] == 2.0);
  }
  EXPECT_EQ(std::count(part.part_of.begin(), part.part_of.end(), -1), 18);
  for (std::size_t e = 0; e < part.mesh.cells.size(); ++e) {
    EXPECT_EQ(gather(part.mesh.points, part.mesh.cells[e]).entries,
              gather(mesh.points, mesh.cells[index(part.element_of[e])]).entries);
  }
}

/// A block with elements of a millimetre on a fixed base; four of its upper faces in the middle go down by
/// `depth`.
struct Touched {
  CaseOnMesh problem;
  Scene scene;

  explicit Touched(const std::array<int, 3>& n, double depth, double poisson_ratio = 0.45) {
    Case touched = plain_case(sample_law<NeoHookean>(poisson_ratio));
    const auto size = [&](std::size_t i) { return 1e-3 * n[i]; };
    Mesh mesh = box({size(0), size(1), size(2)}, n);
    NodeSets sets;
    sets["base"] = nodes_where(mesh.points, [](const Vector& X) { return X[2] == 0.0; });
    sets["touched"] = nodes_where(mesh.points, [&](const Vector& X) {
      return X[2] > size(2) - 1e-6 && std::abs(X[0] - 0.5 * size(0)) < 1.1e-3 &&
             std::abs(X[1] - 0.5 * size(1)) < 1.1e-3;
    });
    touched.displacements = {{"base", {}}, {"touched", {0, 0, -depth}}};
    touched.relaxation.tolerance = 1e-6;
    touched.relaxation.check_interval = 2;
    problem = {std::move(touched), std::move(mesh), std::move(sets)};
    scene = make_scene(problem);
  }

  NodalField whole(const std::string& method) const {
    Observer nobody;
    const Model model(scene, {.method = method});
    return relax(model, nobody).u;
  }

  LocalRelaxation awake(const std::string& method, double share) const {
    Observer nobody;
    return relax_awake(scene, {.method = method}, share, nobody);
  }
};

/// Motion decays within a few times the height in a thin block and as 1 / r in a thick one; nearly
/// incompressible blocks push it elsewhere: neglected motion stays within its limit everywhere. A tolerance
/// of 1e-6 is far below the shares.
TEST(Sleep, neglects_no_more_than_it_may) {
  const double depth = 1e-3;
  const Touched thin({64, 64, 3}, depth);
  const NodalField u = thin.whole("tl-perturbation");
  std::size_t before = 0;
  for (const double share : {0.05, 0.01, 0.001}) {
    const LocalRelaxation local = thin.awake("tl-perturbation", share);
    EXPECT_TRUE(local.relaxation.converged);
    const double neglected = largest_distance(local.relaxation.u, u);
    EXPECT_LT(neglected, share * depth) << share;
    EXPECT_GT(neglected, 0.1 * share * depth) << "more sleeps than might";
    EXPECT_GT(local.elements, before) << "less may be neglected";
    before = local.elements;
  }
  EXPECT_LT(before, thin.scene.mesh.cells.size() / 2) << "at 0.1 %";

  for (const double poisson_ratio : {0.3, 0.49}) {
    const Touched thick({32, 32, 12}, depth, poisson_ratio);
    const LocalRelaxation local = thick.awake("tl-perturbation", 0.1);
    EXPECT_LT(largest_distance(local.relaxation.u, thick.whole("tl-perturbation")), 0.1 * depth);
    EXPECT_LT(local.elements, thick.scene.mesh.cells.size());
  }
}

/// All kinds of methods support sleep: elements' memory and levels stay with the part. A push this deep moves
/// the surroundings farther than its beginning suggests.
TEST(Sleep, holds_for_methods_of_every_kind) {
  const double depth = 1.2e-3, share = 0.02;
  const Touched scene({48, 48, 3}, depth);
  for (const std::string method : {"tl-adaptive", "ul-perturbation", "tl-mean-dilatation", "linear"}) {
    const LocalRelaxation local = scene.awake(method, share);
    EXPECT_LT(largest_distance(local.relaxation.u, scene.whole(method)), share * depth) << method;
    EXPECT_LT(local.elements, scene.scene.mesh.cells.size()) << method;
  }
}

/// If everything has to be awake, the answer is that of the whole body.
TEST(Sleep, everything_awake_is_the_whole) {
  const Touched scene({8, 8, 4}, 0.5e-3);
  const LocalRelaxation local = scene.awake("tl-perturbation", 1e-4);
  EXPECT_EQ(local.elements, scene.scene.mesh.cells.size());
  EXPECT_EQ(local.relaxation.u, scene.whole("tl-perturbation"));
}

TEST(Sleep, listeners_hear_of_the_whole_mesh) {
  const Touched scene({48, 48, 3}, 0.5e-3);
  Recorder recorder;
  const LocalRelaxation local = relax_awake(scene.scene, {.method = "tl-adaptive"}, 0.02, recorder);
  const std::size_t nodes = scene.scene.mesh.points.size(), elements = scene.scene.mesh.cells.size();
  ASSERT_GE(recorder.frames.size(), 2U);
  for (const Frame& frame : recorder.frames) {
    EXPECT_EQ(frame.u.size(), nodes);
    EXPECT_EQ(frame.v.size(), nodes);
    EXPECT_EQ(frame.jacobians.size(), elements);
    EXPECT_EQ(frame.hourglass_energy_densities.size(), elements);
    EXPECT_EQ(frame.levels.size(), elements);
    EXPECT_EQ(frame.stresses.size(), 9 * elements);
  }
  EXPECT_EQ(recorder.frames.front().time, 0.0);
  EXPECT_EQ(recorder.frames.back().u, local.relaxation.u);
  std::size_t asleep = 0;
  for (std::size_t e = 0; e < elements; ++e) {
    if (recorder.frames.back().jacobians[e] != 1.0) continue;
    ++asleep;
    for (const int node : scene.scene.mesh.cells[e])
      EXPECT_EQ(local.relaxation.u[index(node)], Vector{}) << e;
  }
  EXPECT_EQ(asleep, elements - local.elements);
  EXPECT_FALSE(recorder.rows.empty());
  Recorder impatient;
  impatient.last_step = 0;
  EXPECT_TRUE(
      relax_awake(scene.scene, {.method = "tl-perturbation"}, 0.02, impatient).relaxation.interrupted);
}

/// Forces wake elements as displacements do; the share that may be neglected is of the largest displacement.
TEST(Sleep, wakes_where_a_force_pushes) {
  Touched touched({48, 48, 3}, 0.5e-3);
  touched.problem.description.displacements.pop_back();
  touched.problem.description.forces.of<DeadForce>() = {{"touched", {0, 0, -0.002}}};
  const Scene scene = make_scene(touched.problem);
  Observer nobody;
  const MethodChoice choice{.method = "tl-perturbation"};
  const NodalField u = relax(Model(scene, choice), nobody).u;
  const LocalRelaxation local = relax_awake(scene, choice, 0.01, nobody);
  EXPECT_LT(largest_distance(local.relaxation.u, u), 0.01 * displacement_unit(scene, u));
  EXPECT_LT(local.elements, scene.mesh.cells.size());
  EXPECT_GT(local.elements, 0U);
}

TEST(Sleep, is_refused_where_it_has_no_sense) {
  const Touched scene({8, 8, 3}, 0.5e-3);
  EXPECT_THROW(scene.awake("linear-condensed", 0.01), InputError) << "it answers at once";
  const Touched untouched({8, 8, 3}, 0.0);
  EXPECT_THROW(untouched.awake("tl-perturbation", 0.01), InputError);
  const auto refusal = [](const Scene& refused) {
    Observer nobody;
    try {
      relax_awake(refused, {.method = "tl-perturbation"}, 0.01, nobody);
    } catch (const InputError& error) {
      return std::string(error.what());
    }
    return std::string("accepted");
  };
  Scene tied = scene.scene;
  tied.ties = {{0, {{1, 1.0}}}};
  EXPECT_NE(refusal(tied).find("a mesh without [[tie]]"), std::string::npos);
  tied.coarser.emplace_back();
  EXPECT_NE(refusal(tied).find("a mesh without [[refine]]"), std::string::npos);
}

/// A part keeps the scene's imposed displacements, sets (in its own numbers), forces, velocities and
/// materials there; its rim is fixed.
TEST(OnPart, keeps_what_the_scene_has_there) {
  Touched touched({4, 4, 3}, 0.5e-3);
  Case& description = touched.problem.description;
  description.velocities = {{.value = {0.0, 0.1, 0.0}, .half_waves = {1, 0, 0}}};
  description.forces.of<DeadForce>() = {{"base", {1.0, 2.0, 3.0}, {}}};
  const Scene whole = make_scene(touched.problem);
  std::vector<bool> marked(whole.mesh.cells.size(), false);
  for (std::size_t e = 0; e < marked.size(); ++e) marked[e] = e % 4 < 3;  // all but x > 3 mm
  const MeshPart part = part_of_mesh(whole.mesh, marked);
  const Scene scene = on_part(whole, part);
  EXPECT_EQ(scene.settings.name, whole.settings.name);
  EXPECT_EQ(scene.driven.size(), 2U);
  std::size_t rim = 0;
  for (const bool on_the_rim : part.on_the_rim) rim += on_the_rim ? 1 : 0;
  ASSERT_EQ(rim, 5U * 4);
  std::size_t held = 0;
  for (const Constraint& c : scene.constraints) {
    const bool fixed = part.on_the_rim[index(c.node)];
    held += fixed ? 1 : 0;
    const auto there = std::ranges::find_if(whole.constraints, [&](const Constraint& other) {
      return other.node == part.node_of[index(c.node)] && other.component == c.component;
    });
    ASSERT_TRUE(fixed || there != whole.constraints.end());
    EXPECT_EQ(c.path, fixed ? ImposedPath{} : there->path);
  }
  EXPECT_EQ(held, 3 * rim);
  for (const auto& [name, set] : scene.sets) {
    std::size_t inside = 0;
    for (const int node : whole.sets.at(name)) inside += part.part_of[index(node)] >= 0 ? 1U : 0U;
    EXPECT_EQ(set.size(), inside) << name;
    for (const int node : set)
      EXPECT_TRUE(std::ranges::binary_search(whole.sets.at(name), part.node_of[index(node)])) << name;
  }
  for (std::size_t n = 0; n < part.node_of.size(); ++n)
    EXPECT_EQ(scene.initial_velocities[n], whole.initial_velocities[index(part.node_of[n])]);
  for (const NodalLoad& load : dead_loads(scene.forces)) {
    const auto all = dead_loads(whole.forces);
    const auto there = std::ranges::find(all, part.node_of[index(load.node)], &NodalLoad::node);
    ASSERT_NE(there, all.end());
    EXPECT_EQ(load.force, there->force);
  }
}

}  // namespace
}  // namespace sandglass::verification::sleep_test
