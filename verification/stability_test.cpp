/// Stability maps: cells with known outcomes, and the properties of maps, axes and files.

#include <gtest/gtest.h>

#include <fstream>
#include <thread>

#include "choice/variations.hpp"
#include "stability/cell.hpp"
#include "stability/cell_files.hpp"
#include "support/scenes.hpp"
#include "support/temporary_folder.hpp"

namespace sandglass::verification::stability_test {
namespace {

constexpr double limit = 0.01;

NodeSetRule plane(const std::string& name, std::size_t axis, double at) {
  NodeSetRule rule{.name = name};
  rule.within[axis] = Interval{at, at};
  return rule;
}

/// A cantilever along x whose end is moved sideways by a fifth of its length, two elements thick.
Case cantilever(double poisson_ratio = 0.49) {
  Case description = plain_case(NeoHookean{.young_modulus = 3000.0, .poisson_ratio = poisson_ratio});
  description.mesh = BoxMesh{{1.0, 0.2, 0.2}, {10, 2, 2}};
  description.sets = {plane("foot", 0, 0.0), plane("head", 0, 1.0)};
  description.displacements = {{"foot", {}}, {"head", {0.0, 0.0, 0.2}}};
  return description;
}

/// One free cube, pushed at one face.
Case free_cube() {
  Case description = plain_case(NeoHookean{.young_modulus = 3000.0, .poisson_ratio = 0.49});
  description.mesh = BoxMesh{{0.1, 0.1, 0.1}, {1, 1, 1}};
  description.sets = {plane("top", 2, 0.1)};
  description.forces.of<DeadForce>() = {{"top", {0.0, 0.0, 0.1}}};
  return description;
}

class CellTest : public ::testing::Test {
 protected:
  Cell cell(const std::string& map, const Case& description, const std::string& method, double x,
            double y = 0.0) {
    return compute_cell(parse_map(map), description, method, x, y, limit, answers);
  }

  Finding found(const std::string& map, const Case& description, const std::string& method, double x,
                double y = 0.0) {
    const Cell c = cell(map, description, method, x, y);
    EXPECT_TRUE(c.finding.has_value()) << c.status;
    return c.finding.value_or(Finding::no_equilibrium);
  }

  Answers answers;
};

/// The golden's own element is good wherever it finds an equilibrium: the two runs are identical.
TEST_F(CellTest, goldens_own_element_is_the_golden) {
  for (const double nu : {0.25, 0.499}) {
    const Cell c = cell("load,nu", cantilever(), "tl-mean-dilatation", 1.5, nu);
    ASSERT_TRUE(c.symptoms) << c.status;
    EXPECT_EQ(c.symptoms->error, 0.0);
    EXPECT_EQ(c.finding, Finding::good);
  }
}

/// Without kappa nothing resists hourglass modes; a kappa near 1 resists them like volume, which locks; full
/// integration locks as Poisson's ratio nears one half.
TEST_F(CellTest, kappa_and_poissons_ratio_fail_as_known) {
  EXPECT_EQ(found("kappa", cantilever(), "tl-perturbation", 0.0), Finding::hourglassing);
  EXPECT_EQ(found("kappa", cantilever(), "tl-perturbation", 0.3), Finding::locking);
  EXPECT_EQ(found("load,nu", cantilever(), "tl-none", 1.0, 0.49), Finding::hourglassing);
  EXPECT_EQ(found("load,nu", cantilever(), "tl-perturbation", 1.0, 0.49), Finding::good);
  EXPECT_EQ(found("load,nu", cantilever(), "tl-full", 1.0, 0.4999), Finding::locking);
}

/// The bound of the stable step is sharp on a free cube: a twentieth below it every mode oscillates, a
/// twentieth above the highest grows by a factor of 1.9 per step.
TEST_F(CellTest, steps_above_the_stable_one_are_unstable) {
  EXPECT_EQ(found("step", free_cube(), "tl-perturbation", 0.95), Finding::good);
  EXPECT_EQ(found("step", free_cube(), "tl-perturbation", 1.05), Finding::unstable);
  EXPECT_EQ(found("step", cantilever(), "tl-mean-dilatation", 3.0), Finding::unstable);
}

/// A zigzag of velocities grows without control, and only then.
TEST_F(CellTest, noise_grows_without_control) {
  EXPECT_EQ(found("noise", cantilever(), "tl-none", 0.001), Finding::hourglassing);
  EXPECT_EQ(found("noise", cantilever(), "tl-perturbation", 0.001), Finding::good);
  EXPECT_EQ(found("noise", cantilever(), "ul-viscous", 0.001), Finding::good);
}

/// The head is pushed through the foot of a body too short to bend aside: no method has an answer, the golden
/// included.
TEST_F(CellTest, where_the_golden_fails_others_are_classified_by_their_breakdown) {
  Case description = cantilever();
  description.mesh = BoxMesh{{1.0, 0.2, 0.2}, {2, 2, 2}};
  description.displacements[1].value = {-0.9, 0.0, 0.0};
  const Cell c = cell("load", description, "tl-mean-dilatation", 1.5);
  EXPECT_TRUE(c.golden_failed);
  EXPECT_TRUE(c.finding == Finding::inverted || c.finding == Finding::no_equilibrium) << c.status;
  EXPECT_NE(c.status, "ok");
}

/// Elastic answers do not depend on the path: after cycles they are the same, to the tolerance of both.
TEST_F(CellTest, elastic_bodies_forget_their_cycles) {
  const auto answer = [&](int cycles) {
    Case description = cantilever();
    description.relaxation.cycles = cycles;
    return compute({description, {"tl-perturbation"}});
  };
  const Answer straight = answer(0), cycled = answer(2);
  EXPECT_EQ(cycled.status, "ok");
  EXPECT_GT(cycled.steps, straight.steps);
  EXPECT_LT(largest_distance(straight.u.back(), cycled.u.back()), 1e-6 * 0.2);
}

TEST_F(CellTest, methods_refuse_what_they_do_not_know) {
  Case description = cantilever();
  description.materials.front().law =
      Viscoelastic<NeoHookean>{{.young_modulus = 3000.0, .poisson_ratio = 0.45}, 0.5, 1.0};
  const Cell c = cell("load", description, "linear", 1.0);
  EXPECT_TRUE(c.refused);
  EXPECT_FALSE(c.finding);
  EXPECT_FALSE(c.status.empty());
}

/// Stretching and skewing is an affine map of body and imposed motion: a method's homogeneous answer has the
/// same gradient in other axes, A H A^-1, exactly.
TEST(Trial, shapes_body_and_motion_alike) {
  Case description = plain_case(NeoHookean{.young_modulus = 3000.0, .poisson_ratio = 0.3});
  description.mesh = BoxMesh{{1.0, 1.0, 1.0}, {2, 2, 2}};
  description.sets = {plane("low", 2, 0.0), plane("high", 2, 1.0)};
  description.displacements = {{"low", {}}, {"high", {0.1, 0.0, 0.2}}};
  const Scene scene =
      scene_of({.description = description, .choice = {"tl-none"}, .aspect = 2.0, .skew = 0.5});
  const auto [low, high] = bounding_box(scene.mesh.points);
  EXPECT_EQ(high[2], 2.0);
  EXPECT_EQ(high[0], 2.0);  // 1 + 0.5 * 2
  for (const Constraint& constraint : scene.constraints) {
    const bool moved = scene.mesh.points[index(constraint.node)][2] > 1.0;
    const Vector expected = moved ? Vector{0.1 + 0.5 * 0.4, 0.0, 0.4} : Vector{};
    EXPECT_EQ(final_value(scene, constraint), expected[index(constraint.component)]);
  }
}

TEST(Trial, keys_differ_where_answers_may) {
  Trial base{cantilever(), {"tl-none"}};
  base.description.forces.of<Obstacle>().push_back({.label = "plate"});  // of the axis of penalties
  const auto changed = [&](const std::function<void(Trial&)>& change) {
    Trial trial = base;
    change(trial);
    return key_of(trial);
  };
  std::set<std::string> keys{key_of(base)};
  keys.insert(changed([](Trial& t) { t.choice.method = "tl-full"; }));
  keys.insert(changed([](Trial& t) { t.choice.kappa = 0.01; }));
  keys.insert(changed([](Trial& t) { t.choice.precision = Precision::single_precision; }));
  keys.insert(changed([](Trial& t) { t.description.relaxation.cycles = 1; }));
  keys.insert(changed([](Trial& t) { t.description.relaxation.tolerance = 1e-6; }));
  for (const Axis& axis : axes()) {
    keys.insert(changed([&](Trial& t) { axis.apply(t, axis.values[1] * (1.0 + 1e-9)); }));
  }
  // 8 bytes is the default; kappa, bytes and cycles are set above by hand.
  EXPECT_GE(keys.size(), 6 + axes().size() - 3);
}

TEST(Map, asks_only_what_matters) {
  const Case description = cantilever();
  EXPECT_TRUE(concerns(parse_map("kappa,nu"), description, "tl-perturbation"));
  EXPECT_FALSE(concerns(parse_map("kappa,nu"), description, "tl-full"));
  EXPECT_FALSE(concerns(parse_map("kappa,nu"), description, "ul-viscous"));  // no static stiffness
  EXPECT_TRUE(concerns(parse_map("kappa,step"), description, "ul-viscous"));
  EXPECT_FALSE(concerns(parse_map("step"), description, "linear-condensed"));
  EXPECT_EQ(usual_maps(description).size(), 8u);
}

TEST(Map, names_what_is_wrong) {
  EXPECT_THROW(parse_map("lode"), InputError);
  EXPECT_THROW(parse_map("load,load"), InputError);
  EXPECT_THROW(parse_map("load,nu,kappa"), InputError);
  std::vector<Map> maps{parse_map("load,nu")};
  for (const char* text : {"nu", "nu=", "nu=0.5", "nu=a", "load=0", "kappa=0.1", "nu=0.3,,0.4"}) {
    EXPECT_THROW(set_values(text, maps), InputError) << text;
  }
  set_values("nu=0.4,0.3,0.4", maps);
  EXPECT_EQ(maps[0].ys, (std::vector{0.3, 0.4}));
  Case description = cantilever();
  description.materials.front().law = Ogden{};
  EXPECT_THROW(require_possible(maps[0], description), InputError);
  EXPECT_EQ(usual_maps(description).size(), 3u);     // aspect-skew, cycles-load, step-load
  description.forces.of<Obstacle>().emplace_back();  // it would keep its shape
  EXPECT_THROW(require_possible(parse_map("skew"), description), InputError);
}

TEST(Answers, are_computed_once) {
  Answers answers;
  const Trial trial{cantilever(), {"tl-perturbation"}};
  std::array<std::shared_ptr<const Answer>, 4> got;
  {
    std::vector<std::jthread> askers;
    for (auto& answer : got) askers.emplace_back([&] { answer = answers.of(trial); });
  }
  for (const auto& answer : got) EXPECT_EQ(answer, got[0]);
}

/// A generator's numbers of elements are scaled in proportion, the smallest to the requested number.
TEST(Variations, elements_across_keep_their_proportions) {
  const auto column = std::get<BoxMesh>(with_elements_across(BoxMesh{{0.1, 0.1, 1.0}, {3, 3, 30}}, 2));
  EXPECT_EQ(column.elements, (std::array{2, 2, 20}));
  const auto ellipsoid = std::get<EllipsoidMesh>(with_elements_across(EllipsoidMesh{{1, 1, 1}, 10, 2}, 3));
  EXPECT_EQ(ellipsoid.core_elements, 15);
  EXPECT_EQ(ellipsoid.shell_layers, 3);
}

/// Both ends of every edge differ, also on unstructured meshes; a ring of three has no zigzag.
TEST(Variations, zigzags_change_sign_along_every_edge) {
  for (const Mesh& mesh : {box({1, 1, 1}, {3, 2, 4}), EllipsoidMesh{{1, 1, 1}, 4, 2}.build()}) {
    const auto signs = zigzag(mesh);
    for (const auto& cell : mesh.cells) {
      for (const auto& [a, b] :
           {std::pair<std::size_t, std::size_t>{0, 1}, {1, 2}, {2, 3}, {3, 0}, {0, 4}, {6, 7}}) {
        EXPECT_EQ(signs[index(cell[a])] + signs[index(cell[b])], 0);
      }
    }
  }
  Mesh ring;
  ring.points.resize(12);
  for (int k = 0; k < 3; ++k) {
    const int a = 4 * k, b = 4 * ((k + 1) % 3);
    ring.cells.push_back({a, b, b + 1, a + 1, a + 3, b + 3, b + 2, a + 2});
  }
  EXPECT_THROW(zigzag(ring), InputError);
}

class CellFilesTest : public ::testing::Test {
 protected:
  TemporaryFolder folder;
  Case description = cantilever();
  Map map = parse_map("load,nu");
  Cell cell{.method = "tl-none",
            .x = 0.1,
            .y = 0.3,
            .finding = Finding::locking,
            .symptoms = Symptoms{0.1, 0.2, 1.0 / 3.0, std::nan("")},
            .status = "why",
            .golden_failed = true,
            .steps = 7};
};

TEST_F(CellFilesTest, give_back_what_they_were_given) {
  const CellFiles files(folder / "cells", description, limit, {{"revision", "r"}});
  EXPECT_FALSE(files.read(map, "tl-none", 0.1, 0.3));
  files.write(map, cell);
  const auto read = files.read(map, "tl-none", 0.1, 0.3);
  ASSERT_TRUE(read);
  EXPECT_EQ(read->finding, cell.finding);
  EXPECT_EQ(read->symptoms->bending_ratio, 1.0 / 3.0);
  EXPECT_TRUE(std::isnan(read->symptoms->stiffness_ratio));
  EXPECT_EQ(read->status, "why");
  EXPECT_TRUE(read->golden_failed);
  EXPECT_EQ(read->steps, 7);
  EXPECT_FALSE(files.read(map, "tl-full", 0.1, 0.3));
}

TEST_F(CellFilesTest, belong_to_a_case_and_a_limit) {
  CellFiles(folder / "cells", description, limit, {}).write(map, cell);
  EXPECT_FALSE(CellFiles(folder / "cells", description, 0.02, {}).read(map, "tl-none", 0.1, 0.3));
  EXPECT_FALSE(CellFiles(folder / "cells", cantilever(0.3), limit, {}).read(map, "tl-none", 0.1, 0.3));
}

TEST_F(CellFilesTest, damaged_ones_are_refused) {
  const CellFiles files(folder / "cells", description, limit, {});
  files.write(map, cell);
  for (const auto& entry : std::filesystem::recursive_directory_iterator(folder / "cells")) {
    if (entry.is_regular_file()) std::ofstream(entry.path()) << "{";
  }
  EXPECT_THROW(files.read(map, "tl-none", 0.1, 0.3), InputError);
}

}  // namespace
}  // namespace sandglass::verification::stability_test
