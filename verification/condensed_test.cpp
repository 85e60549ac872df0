/// Condensation to the driven nodes: exact superposition of the linear method's answers.

#include <gtest/gtest.h>

#include "base/error.hpp"
#include "solve/central_difference.hpp"
#include "solve/layered_cholesky.hpp"
#include "support/allocations.hpp"
#include "support/distorted_bar.hpp"
#include "support/temporary_folder.hpp"

namespace sandglass::verification::condensed_test {
namespace {

constexpr double eps = std::numeric_limits<double>::epsilon();

const MethodChoice linear_method{"linear"};
const MethodChoice condensed_method{"linear-condensed"};

/// A residual of 1e-12 leaves errors of 1e-12 times the condition number of the bar, a few hundred.
constexpr double relaxed_tolerance = 1e-9;

TEST(CondensedTest, answer_is_that_of_the_linear_method) {
  const Vector d{0.03, -0.01, 0.02};
  for (const std::optional<double> kappa : {std::optional<double>{}, std::optional<double>{0.02}}) {
    MethodChoice linear = linear_method, condensed = condensed_method;
    linear.kappa = condensed.kappa = kappa;
    const Scene scene = distorted_bar(d);
    EXPECT_LT(largest_distance(relaxed(scene, condensed), relaxed(scene, linear)),
              relaxed_tolerance * largest_imposed(scene));
  }
}

/// Only some of a node's components may be imposed; the others remain free.
TEST(CondensedTest, free_components_of_driven_nodes_are_free) {
  const Scene scene = distorted_bar({0.0, 0.0, 0.02}, {false, false, true});
  const NodalField u = relaxed(scene, condensed_method);
  EXPECT_LT(largest_distance(u, relaxed(scene, linear_method)), relaxed_tolerance * largest_imposed(scene));
  EXPECT_GT(std::abs(u[index(scene.sets.at("head").front())][0]), 1e-4);  // the head contracts
}

TEST(CondensedTest, takes_one_step_and_reports_its_residual_and_its_work) {
  Scene scene = distorted_bar({0.03, -0.01, 0.02});
  scene.settings.relaxation.max_steps = 1;
  Recorder recorder;
  const Relaxation answer = relax(Model(scene, condensed_method), recorder);
  EXPECT_TRUE(answer.converged);
  EXPECT_EQ(answer.steps, 1);
  EXPECT_LT(answer.residual, 1e-12);
  EXPECT_GT(answer.residual, 0.0);
  ASSERT_EQ(recorder.frames.size(), 2U);
  EXPECT_EQ(recorder.frames.back().u, answer.u);
  // Force and displacement are proportional: the work of imposed displacements is the only energy.
  const HistoryRow& row = recorder.rows.back();
  EXPECT_NEAR(row.external_work, row.strain + row.hourglass, 1e-11 * row.strain);
}

TEST(CondensedTest, single_precision_is_as_near_as_its_digits) {
  const Scene scene = distorted_bar({0.03, -0.01, 0.02});
  MethodChoice choice = condensed_method;
  choice.precision = Precision::single_precision;
  Observer silent;
  const Relaxation answer = relax(Model(scene, choice), silent);
  EXPECT_TRUE(in_equilibrium(answer));
  // Columns, products and sums of six numbers are each rounded once.
  EXPECT_LT(largest_distance(answer.u, relaxed(scene, condensed_method)), 8 * 6e-8 * largest_imposed(scene));
}

TEST(CondensedTest, answers_superpose) {
  const Scene scene = distorted_bar({0.03, -0.01, 0.02});
  const auto response = response_of_sets(scene);
  const std::array<Vector, 2> d{Vector{0.1, -0.2, 0.3}, Vector{0.0, 0.4, -0.1}};
  const std::array<Vector, 2> e{Vector{-0.3, 0.0, 0.1}, Vector{0.2, 0.1, 0.5}};
  std::array<Vector, 2> both{};
  for (std::size_t h = 0; h < 2; ++h) {
    for (std::size_t i = 0; i < 3; ++i) both[h][i] = 2.0 * d[h][i] - 3.0 * e[h][i];
  }
  NodalField u_d(scene.mesh.points.size()), u_e(u_d), u_both(u_d);
  response.displacements(d, u_d);
  response.displacements(e, u_e);
  response.displacements(both, u_both);
  for (std::size_t n = 0; n < u_d.size(); ++n) {
    for (std::size_t i = 0; i < 3; ++i) {
      EXPECT_NEAR(u_both[n][i], 2.0 * u_d[n][i] - 3.0 * u_e[n][i], 64 * eps);
    }
  }
}

/// S is symmetric because an energy exists. Moving all handles by the same vector needs no force and moves
/// every node by this vector.
TEST(CondensedTest, stiffness_is_symmetric_and_blind_to_translation) {
  const Scene scene = distorted_bar({0.03, -0.01, 0.02});
  for (const Handles& handles : {handles_of_sets(scene), handles_of_nodes(scene)}) {
    const CondensedResponse<double> response(Model(scene, condensed_method), handles, all_nodes(scene));
    const std::size_t columns = 3 * response.handles();
    const auto& S = response.stiffness();
    ASSERT_EQ(S.size(), columns * columns);
    const double largest = *std::max_element(S.begin(), S.end());
    for (std::size_t row = 0; row < columns; ++row) {
      for (std::size_t column = 0; column < row; ++column) {
        EXPECT_NEAR(S[row * columns + column], S[column * columns + row], 1e-12 * largest);
      }
    }
    const std::vector<Vector> d(response.handles(), {0.1, 0.2, -0.3});
    std::vector<Vector> f(d.size());
    NodalField u(scene.mesh.points.size());
    response.displacements(d, u);
    response.forces(d, f);
    EXPECT_LT(largest_distance(u, NodalField(u.size(), d[0])), 1e-11);
    EXPECT_LT(largest_distance(f, std::vector<Vector>(f.size())), 1e-11 * largest);
  }
}

/// Forces on handles are the reactions of the linear method, for single nodes and for sets.
TEST(CondensedTest, forces_are_the_reactions_of_the_linear_method) {
  const Scene scene = distorted_bar({0.03, -0.01, 0.02});
  const NodalField u = relaxed(scene, linear_method);
  const NodalField reaction = internal_forces(Model(scene, linear_method), u);
  Vector on_head{};
  for (const int n : scene.sets.at("head")) {
    for (std::size_t i = 0; i < 3; ++i) on_head[i] += reaction[index(n)][i];
  }
  const double size = std::hypot(on_head[0], on_head[1], on_head[2]);
  std::vector<Vector> f(2);
  response_of_sets(scene).forces(std::vector<Vector>{{}, {0.03, -0.01, 0.02}}, f);
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_NEAR(f[1][i], on_head[i], relaxed_tolerance * size);
    EXPECT_NEAR(f[0][i], -on_head[i], relaxed_tolerance * size);
  }
  const CondensedResponse<double> nodes(Model(scene, condensed_method), handles_of_nodes(scene), {});
  std::vector<Vector> d, exact;
  for (std::size_t n = 0; n < u.size(); ++n) {
    const auto driven = [&](const char* set) {
      const auto& members = scene.sets.at(set);
      return std::binary_search(members.begin(), members.end(), static_cast<int>(n));
    };
    if (!driven("foot") && !driven("head")) continue;
    d.push_back(u[n]);
    exact.push_back(reaction[n]);
  }
  ASSERT_EQ(d.size(), nodes.handles());
  f.resize(d.size());
  nodes.forces(d, f);
  EXPECT_LT(largest_distance(f, exact), relaxed_tolerance * size);
}

/// Requested nodes have the values of the whole answer, in the requested order.
TEST(CondensedTest, outputs_are_the_nodes_asked_for) {
  const Scene scene = distorted_bar({0.03, -0.01, 0.02});
  const std::vector<Vector> d{{}, {0.03, -0.01, 0.02}};
  NodalField all(scene.mesh.points.size()), few(3);
  response_of_sets(scene).displacements(d, all);
  const std::vector<int> wanted{70, 20, 45};
  const CondensedResponse<double> response(Model(scene, condensed_method), handles_of_sets(scene), wanted);
  response.displacements(d, few);
  for (std::size_t k = 0; k < 3; ++k) EXPECT_EQ(few[k], all[index(wanted[k])]);
  // Nine numbers for each of two handles and three nodes, and 6 x 6 for the forces.
  EXPECT_EQ(response.operations(), 2.0 * (9 * 2 * 3 + 36));
  EXPECT_EQ(response.bytes(), 8.0 * (9 * 2 * 3 + 9 + 36 + 12));
}

TEST(CondensedTest, update_allocates_nothing) {
  const Scene scene = distorted_bar({0.03, -0.01, 0.02});
  const auto response = response_of_sets(scene);
  const std::vector<Vector> d{{0.01, 0.0, 0.0}, {0.03, -0.01, 0.02}};
  std::vector<Vector> f(2);
  NodalField u(scene.mesh.points.size());
  const long before = allocations();
  EXPECT_GT(before, 0);  // allocations are counted
  response.displacements(d, u);
  response.forces(d, f);
  EXPECT_EQ(allocations(), before);
}

TEST(CondensedTest, threads_do_not_change_a_bit) {
  const Scene scene = distorted_bar({0.03, -0.01, 0.02}, {true, true, true}, 2);
  ASSERT_GT(3 * scene.mesh.points.size(), 4U * 512);  // several blocks to distribute
  const auto response = response_of_sets(scene);
  const std::vector<Vector> d{{0.01, 0.0, 0.0}, {0.03, -0.01, 0.02}};
  NodalField alone(scene.mesh.points.size());
  response.displacements(d, alone);
  for (const int threads : {2, 3}) {
    NodalField shared(alone.size());
    response.displacements(d, shared, threads);
    EXPECT_EQ(shared, alone);
  }
}

/// Driven nodes may move independently: the head twists and bulges as in the linear method's solution.
TEST(CondensedTest, driven_nodes_may_move_each_by_itself) {
  const Scene bar = distorted_bar({});
  const auto twist = [](const Vector& X) {
    return X[2] > 0.2 ? Vector{-0.3 * X[1], 0.3 * X[0], 2.0 * X[0] * X[1]} : Vector{};
  };
  Case description = plain_case(bar.materials.list.front().law);
  description.relaxation = bar.settings.relaxation;
  NodeSets sets;
  std::vector<Vector> d;
  std::vector<int> driven;
  for (const auto& constraint : bar.constraints) {
    if (constraint.component != 0) continue;
    driven.push_back(constraint.node);
    d.push_back(twist(bar.mesh.points[index(constraint.node)]));
  }
  impose_field(driven, bar.mesh.points, twist, description, sets);
  const Scene twisted = make_scene(description, bar.mesh, sets);
  const CondensedResponse<double> nodes(Model(bar, condensed_method), handles_of_nodes(bar), all_nodes(bar));
  NodalField u(bar.mesh.points.size());
  nodes.displacements(d, u);
  EXPECT_LT(largest_distance(u, relaxed(twisted, linear_method)),
            relaxed_tolerance * largest_imposed(twisted));
}

/// Loads superpose on imposed displacements: at free nodes the internal forces of the linear method equal the
/// load, and the forces on handles balance all of it. By reciprocity (Maxwell and Betti), forces on held
/// handles under a load follow from displacements at the load when handles move: R = -response^T f.
TEST(CondensedTest, loads_superpose) {
  const Scene scene = distorted_bar({0.03, -0.01, 0.02});
  NodalField load(scene.mesh.points.size());
  load[70] = {0.01, -0.02, 0.03};
  load[55] = {-0.04, 0.0, 0.01};
  const CondensedResponse<double> response(Model(scene, condensed_method), handles_of_sets(scene),
                                           all_nodes(scene), {load});
  const std::vector<Vector> d{{}, {0.03, -0.01, 0.02}}, held(2);
  const std::array<double, 1> factor{2.5}, one{1.0};
  std::vector<Vector> f(2), R(2);
  NodalField u(load.size()), moved(load.size());
  response.displacements(d, u, 1, factor);
  response.forces(d, f, factor);
  const NodalField internal = internal_forces(Model(scene, linear_method), u);
  std::vector<bool> driven(load.size(), false);
  for (const auto& constraint : scene.constraints) driven[index(constraint.node)] = true;
  double largest = 0.0;
  for (const auto& force : internal) largest = std::max(largest, std::abs(force[0]));
  Vector sum{};
  for (std::size_t n = 0; n < load.size(); ++n) {
    for (std::size_t i = 0; i < 3; ++i) {
      sum[i] += factor[0] * load[n][i];
      if (driven[n]) continue;
      EXPECT_NEAR(internal[n][i], factor[0] * load[n][i], 1e-11 * largest);
    }
  }
  for (std::size_t i = 0; i < 3; ++i) EXPECT_NEAR(f[0][i] + f[1][i], -sum[i], 1e-10 * largest);
  response.forces(held, R, one);
  for (std::size_t column = 0; column < 6; ++column) {
    std::vector<Vector> unit(2);
    unit[column / 3][column % 3] = 1.0;
    response.displacements(unit, moved);
    double work = 0.0;
    for (std::size_t n = 0; n < load.size(); ++n) {
      for (std::size_t i = 0; i < 3; ++i) work += load[n][i] * moved[n][i];
    }
    EXPECT_NEAR(R[column / 3][column % 3], -work, 1e-11 * 0.05);  // forces of a few hundredths
  }
}

/// Two loads with factors of their own equal their sum as one load, up to roundoff of displacements of some
/// centimetres and of forces of a tenth.
TEST(CondensedTest, loads_have_factors_of_their_own) {
  const Scene scene = distorted_bar({0.03, -0.01, 0.02});
  NodalField one(scene.mesh.points.size()), other = one, sum = one;
  one[70] = {0.01, -0.02, 0.03};
  other[55] = {-0.04, 0.0, 0.01};
  for (std::size_t n = 0; n < sum.size(); ++n) {
    for (std::size_t i = 0; i < 3; ++i) sum[n][i] = 2.0 * one[n][i] - 3.0 * other[n][i];
  }
  const auto answer = [&](const std::vector<NodalField>& loads, std::span<const double> factors) {
    const CondensedResponse<double> response(Model(scene, condensed_method), handles_of_sets(scene),
                                             all_nodes(scene), loads);
    const std::vector<Vector> held(2);
    std::pair found{NodalField(sum.size()), std::vector<Vector>(2)};
    response.displacements(held, found.first, 1, factors);
    response.forces(held, found.second, factors);
    return found;
  };
  const auto [u, f] = answer({one, other}, std::array{2.0, -3.0});
  const auto [u_sum, f_sum] = answer({sum}, std::array{1.0});
  EXPECT_GT(largest_distance(u_sum, NodalField(u.size())), 1e-3);
  EXPECT_LT(largest_distance(u, u_sum), 64 * eps);
  EXPECT_LT(largest_distance(f, f_sum), 1e-12);
}

/// A node of two sets follows the first.
TEST(CondensedTest, nodes_of_two_sets_follow_the_first) {
  CaseOnMesh bar = distorted_bar_case({0.0, 0.0, 0.02});
  const int shared = bar.sets.at("head").front();
  bar.sets["one"] = {shared};
  bar.description.displacements.push_back({"one", {0.0, 0.0, 0.02}});
  const Scene scene = make_scene(bar);
  const Handles handles = handles_of_sets(scene);
  ASSERT_EQ(handles.count, 2U);
  for (std::size_t k = 0; k < scene.constraints.size(); ++k) {
    if (scene.constraints[k].node == shared) {
      EXPECT_EQ(handles.of_constraint[k], 1) << k;
    }
  }
}

TEST(CondensedTest, scenes_that_it_cannot_answer_are_refused) {
  Case description = plain_case(sample_law<NeoHookean>(0.49));
  const Mesh mesh = box({0.1, 0.1, 0.1}, {2, 2, 2});
  const Scene nothing = make_scene(description, mesh);
  const std::string text = input_error([&] { response_of_sets(nothing, condensed_method); });
  EXPECT_TRUE(contains(text, "made-in-a-test.toml"));
  EXPECT_TRUE(contains(text, "linear-condensed"));
  EXPECT_TRUE(contains(text, "displacement"));

  Scene moving = distorted_bar({0.0, 0.0, 0.01});
  moving.settings.quasi_static = false;
  moving.settings.dynamics.duration = 0.1;
  Observer silent;
  const std::string still = input_error([&] { integrate(Model(moving, condensed_method), silent); });
  EXPECT_TRUE(contains(still, "no dynamics"));
  EXPECT_TRUE(contains(still, "'linear'"));

  EXPECT_TRUE(
      contains(input_error([&] { response_of_sets(moving, {"tl-perturbation"}); }), "no constant stiffness"));

  // Held at one edge only, a body turns freely about it.
  NodeSets sets;
  impose_field(
      nodes_where(mesh.points, [](const Vector& X) { return X[0] == 0.0 && X[1] == 0.0; }), mesh.points,
      [](const Vector&) { return Vector{}; }, description, sets);
  const Scene hinged = make_scene(description, mesh, sets);
  try {
    response_of_sets(hinged, condensed_method);
    FAIL() << "a body that may turn freely was given an answer";
  } catch (const ComputationError& error) {
    EXPECT_TRUE(contains(error.what(), "positive definite"));
    EXPECT_TRUE(contains(error.what(), "remedy: "));
  }
}

/// Layers include every node, and neighbours are at most one layer apart.
TEST(LayersTest, neighbours_are_at_most_a_layer_apart) {
  // A ring of nine, a pair next to it, and a single one.
  std::vector<std::vector<int>> neighbours(12);
  for (int n = 0; n < 9; ++n) neighbours[index(n)] = {(n + 1) % 9, (n + 8) % 9};
  neighbours[9] = {10};
  neighbours[10] = {9};
  const auto layers = layers_from({4, 5}, neighbours);
  ASSERT_EQ(layers.size(), 8U);
  EXPECT_EQ(layers[0], (std::vector<int>{4, 5}));
  EXPECT_EQ(layers[1], (std::vector<int>{3, 6}));
  EXPECT_EQ(layers[4], (std::vector<int>{0}));
  EXPECT_EQ(layers[5], (std::vector<int>{9}));
  EXPECT_EQ(layers[6], (std::vector<int>{10}));
  EXPECT_EQ(layers[7], (std::vector<int>{11}));
}

/// Solves A x = b for a matrix with layers of different sizes, one of them empty; b is the product with x,
/// formed entry by entry.
TEST(LayeredCholeskyTest, solves_what_was_added) {
  const std::vector<int> sizes{3, 5, 1, 0, 4, 7};
  RandomGeometry random(41);
  std::vector<int> layer;
  for (std::size_t k = 0; k < sizes.size(); ++k)
    layer.insert(layer.end(), index(sizes[k]), static_cast<int>(k));
  const int n = static_cast<int>(layer.size());
  LayeredCholesky factor(sizes);
  std::vector<double> x(index(n)), b(index(n), 0.0);
  for (auto& entry : x) entry = random.uniform(-1, 1);
  for (int row = 0; row < n; ++row) {
    for (int column = 0; column <= row; ++column) {
      if (layer[index(row)] - layer[index(column)] > 1) continue;
      // Diagonally dominant: at most 16 others, each at most 1, in a row.
      const double value = row == column ? 20.0 + random.uniform(0, 1) : random.uniform(-1, 1);
      factor.add(row, column, 0.25 * value);
      factor.add(row, column, 0.75 * value);
      factor.add(column, row, row == column ? 0.0 : value);  // the upper half is ignored
      b[index(row)] += value * x[index(column)];
      if (row != column) b[index(column)] += value * x[index(row)];
    }
  }
  factor.factorise();
  factor.solve(b);
  for (int row = 0; row < n; ++row) EXPECT_NEAR(b[index(row)], x[index(row)], 64 * eps);
}

TEST(LayeredCholeskyTest, refuses_what_is_not_positive_definite) {
  LayeredCholesky factor({1, 1});
  factor.add(0, 0, 1.0);
  factor.add(1, 0, 1.0);
  factor.add(1, 1, 1.0 + 1e-16);  // singular up to roundoff
  EXPECT_THROW(factor.factorise(), ComputationError);
}

}  // namespace
}  // namespace sandglass::verification::condensed_test
