/// Bodies that rigid obstacles press in static equilibrium. Exact answers.

#include <gtest/gtest.h>

#include "io/case_file.hpp"
#include "solve/relaxation.hpp"
#include "support/obstacles.hpp"
#include "support/temporary_folder.hpp"

namespace sandglass::verification::resting_contact_test {
namespace {

/// The largest distance of displacements from others, over the largest of those.
double relative_change(const NodalField& u, const NodalField& other) {
  return largest_distance(u, other) / largest_distance(u, NodalField(u.size()));
}

/// A plate pressed by D onto a column of the length L without lateral strain, pressure = E (D - d) / L = p E
/// / h d with the penalty p, so that the depth is D / (1 + r), r = p L / h. Each of three augmentations
/// divides it by 1 + r. The residual at the last of them, 1e-5, is the error of the first depth that is left.
TEST(RestingContact, presses_a_column_as_derived) {
  const double L = 3.0, D = 0.1, E = 3000.0;
  Column column({1.0, 2.0, L}, {2, 2, 4}, NeoHookean{.young_modulus = E, .poisson_ratio = 0.0});
  column.description.displacements = {{"foot", {}}};
  for (const auto& [gap, penalty] : {std::pair{0.0, 1.0}, {0.05, 1.0}, {0.05, Obstacle{}.penalty}}) {
    Obstacle plate = ceiling(L + gap, D + gap);
    plate.penalty = penalty;
    column.description.forces.of<Obstacle>() = {plate};
    Recorder recorder;
    const Scene scene = column.scene();
    const Relaxation found = relax(Model(scene, {"linear"}), recorder);
    EXPECT_TRUE(found.converged);
    const double h = 0.5, share = 1.0 / (1.0 + penalty * L / h), depth = D * std::pow(share, 4),
                 force = E * (D - depth) / L * 2.0;
    const double within = 1e-5 * share * D;
    const HistoryRow& last = recorder.rows.back();
    EXPECT_NEAR(last.depth, depth, within);
    EXPECT_NEAR(last.reactions.at("plate")[2], -force, E * within / L * 2.0);
    EXPECT_NEAR(last.reactions.at("foot")[2], force, E * within / L * 2.0);
    // The middle of the column is the arm from the point of the plate.
    const double found_force = last.reactions.at("plate")[2];
    const Vector moment{found_force * 1.0, found_force * -0.5, 0.0};
    EXPECT_LT(distance(last.moments.at("plate"), moment), 1e-6 * force);
    EXPECT_NEAR(last.contact, force * depth, force * within);
  }
}

/// A block that a ball presses.
constexpr const char* pressed_block = R"(
[mesh]
generator = "box"
size = [0.1, 0.1, 0.05]
elements = [12, 12, 6]

[sets]
held = { z = [0.0, 0.0] }
top = { z = [0.05, 0.05] }

[[obstacle]]
name = "ball"
set = "top"
shape = "sphere"
point = [0.045, 0.055, 0.09]
radius = 0.04
displacement = [0.002, 0.001, -0.008]
)";

/// An ellipsoid, held at its lower end, that slides under its weight in a cavity which just contains it.
constexpr const char* sliding_ellipsoid = R"(
[mesh]
generator = "ellipsoid"
semi_axes = [0.1, 0.085, 0.08]
core_elements = 6
shell_layers = 1

[sets]
held = { surface = true, z = [-inf, -0.07] }
covered = { surface = true, z = [-0.07, 0.07] }

[[gravity]]
value = [9.81, 0.0, 0.0]

[[obstacle]]
name = "skull"
set = "covered"
shape = "ellipsoid"
inside = true
point = [0.0, 0.0, 0.0]
half_sizes = [0.1, 0.085, 0.08]
)";

/// A body that an obstacle presses, read from a file.
Relaxation answer_of(const TemporaryFolder& folder, const std::string& body, const std::string& ratio,
                     const std::string& settings = "") {
  const auto path = folder.write("touching.toml", fmt::format(R"(
[case]
name = "touching"
requirement = "a test"
answer = "quasi-static"

[material]
law = "neo-hookean"
young_modulus = 3000.0
poisson_ratio = {}
density = 1000.0

[[displacement]]
set = "held"
value = [0.0, 0.0, 0.0]
)",
                                                              ratio) +
                                                      body + settings);
  const Scene scene = read_scene(path);
  Recorder recorder;
  Relaxation found = relax(Model(scene, {"tl-mean-dilatation"}), recorder);
  EXPECT_TRUE(found.converged);
  EXPECT_EQ(found.stability, Stability::stable);
  return found;
}

/// The search is short where the nodes that touch are not known in advance: 49 to 86 evaluations for the
/// ellipsoid, and thousands if contact changes in every accelerated step, or if the multigrid cycle takes the
/// lambda of Poisson's ratio 0.4999.
TEST(RestingContact, is_found_in_few_evaluations) {
  const TemporaryFolder folder;
  for (const char* ratio : {"0.3", "0.49", "0.4999"}) {
    EXPECT_LT(answer_of(folder, pressed_block, ratio).steps, 100);
    EXPECT_LT(answer_of(folder, sliding_ellipsoid, ratio).steps, 150);
  }
}

/// The answer is that of a rigid obstacle: neither the load levels before nor the penalty change it, except
/// for the depth that is left, 1e-5 of the displacements with a penalty of a third. When contact was
/// augmented only once, at a residual of 1e-3, they changed it by 3e-5 to 5e-4.
TEST(RestingContact, has_one_answer) {
  const TemporaryFolder folder;
  for (const char* body : {pressed_block, sliding_ellipsoid}) {
    const NodalField u = answer_of(folder, body, "0.45").u;
    for (const char* settings :
         {"penalty = 10.0\n", "[relaxation]\nlevels = 1\n", "[relaxation]\nlevels = 7\n"}) {
      const NodalField other = answer_of(folder, body, "0.45", settings).u;
      EXPECT_LT(relative_change(u, other), 1e-5) << settings;
    }
  }
}

/// Where a node would cut a corner of a box on its way through a load level, levels are shortened: in one
/// level, side faces of the box held nodes that it presses down on a longer path, and the force was 685 N
/// instead of 1000 N.
TEST(RestingContact, passes_around_corners) {
  Column block({1.0, 1.0, 1.0}, {2, 3, 1}, NeoHookean{.young_modulus = 1e4, .poisson_ratio = 0.3});
  const std::vector<bool> outer = boundary_nodes(block.mesh);
  for (std::size_t k = 0; k < outer.size(); ++k) {
    if (outer[k]) block.sets["all"].push_back(static_cast<int>(k));
  }
  block.description.displacements = {{"foot", {}}};
  Obstacle tool{.label = "tool", .set = "all", .shape = Obstacle::Shape::box, .point = {0.5438, 0.6258, 1.3}};
  tool.half_sizes = {0.5469, 0.4578, 0.3};
  tool.displacement = {-0.00696, 0.00591, -0.1147};
  block.description.forces.of<Obstacle>() = {tool};
  std::vector<double> forces;
  for (const int levels : {0, 12, 50}) {
    block.description.relaxation.levels = levels;
    Recorder recorder;
    const Scene scene = block.scene();
    const Relaxation found = relax(Model(scene, {"tl-mean-dilatation"}), recorder);
    EXPECT_TRUE(found.converged);
    forces.push_back(recorder.rows.back().reactions.at("tool")[2]);
  }
  EXPECT_NEAR(forces[1], -1000.0, 5.0);
  for (const double force : forces) EXPECT_NEAR(force, forces[1], 1e-5 * std::abs(forces[1]));
}

/// A search that leaves a saddle augments contact anew: with the constant forces of the saddle, the force of
/// a block below a groove was 736 N instead of 732 N.
TEST(RestingContact, augments_beyond_a_saddle) {
  Column block({1.0, 1.0, 1.0}, {1, 2, 3}, NeoHookean{.young_modulus = 1e4, .poisson_ratio = 0.45});
  block.description.displacements = {{"foot", {}}};
  Obstacle side = ceiling(0.0, 0.0);
  side.set = "top";
  side.penalty = Obstacle{}.penalty;
  side.point = {0.6776957, 0.0, 1.6999405};
  side.displacement = {0.08016719, 0.07422025, -0.50903924};
  side.normal = {0.5999405, 0.0, -1.0};
  Obstacle other = side;
  other.label = "other";
  other.normal = {-0.5999405, -0.09709349, -1.0};
  block.description.forces.of<Obstacle>() = {side, other};
  std::vector<double> forces;
  std::vector<Stability> stabilities;
  for (const int levels : {0, 15}) {
    block.description.relaxation.levels = levels;
    Recorder recorder;
    const Scene scene = block.scene();
    stabilities.push_back(relax(Model(scene, {"tl-mean-dilatation"}), recorder).stability);
    forces.push_back(recorder.rows.back().reactions.at("foot")[2]);
  }
  EXPECT_EQ(stabilities, (std::vector{Stability::saddle_left, Stability::stable}));
  EXPECT_NEAR(forces[0], forces[1], 1e-5 * std::abs(forces[1]));
}

/// A cube on a floor, and a ball pressed into a cavity.
constexpr std::array bodies_of_float{R"(
[mesh]
generator = "box"
size = [1.0, 1.0, 1.0]
elements = [3, 1, 3]

[sets]
all = { surface = true }
side = { x = [0.0, 0.0] }
front = { y = [0.0, 0.0] }

[[displacement]]
set = "side"
value = [0.0, 0.0, 0.0]
components = "x"

[[displacement]]
set = "front"
value = [0.0, 0.0, 0.0]
components = "y"

[[gravity]]
value = [0.0, 0.0, -10.4098]

[[obstacle]]
name = "floor"
set = "all"
shape = "plane"
point = [0.0, 0.0, 0.0]
normal = [0.0, 0.0, 1.0]
)",
                                     R"(
[mesh]
generator = "ellipsoid"
semi_axes = [0.5, 0.5, 0.5]
core_elements = 3
shell_layers = 1

[sets]
all = { surface = true }
head = { surface = true, z = [0.3, inf] }

[[displacement]]
set = "head"
value = [0.0084, -0.0312, -0.1463]

[[obstacle]]
name = "bowl"
set = "all"
shape = "capsule"
inside = true
point = [0.0, -0.3, 0.0]
end = [0.0, 0.3, 0.0]
radius = 0.62
)"};

/// Single precision finds the answer of double precision, or none: bodies without any hold but contact flew
/// away for kilometres, where their weight is rounding, and a search that ended was one that had found
/// equilibrium before.
TEST(RestingContact, in_single_precision_is_right_or_none) {
  const TemporaryFolder folder;
  for (const char* body : bodies_of_float) {
    for (const char* modulus : {"1e3", "1e5"}) {
      const auto path = folder.write("float.toml", fmt::format(R"(
[case]
name = "float"
requirement = "a test"
answer = "quasi-static"

[material]
law = "neo-hookean"
young_modulus = {}
poisson_ratio = 0.3
density = 100.0

[relaxation]
max_steps = 20000
)",
                                                               modulus) +
                                                       body);
      const Scene scene = read_scene(path);
      for (const char* method : {"t4", "linear", "tl-energy-sampling", "tl-perturbation"}) {
        const auto answer = [&](Precision precision) {
          Observer silent;
          return relax(Model(scene, {method, {}, precision}), silent);
        };
        Relaxation single;
        try {
          single = answer(Precision::single_precision);
        } catch (const ComputationError&) {
          continue;
        }
        if (!in_equilibrium(single)) continue;
        const Relaxation exact = answer(Precision::double_precision);
        EXPECT_LT(relative_change(exact.u, single.u), 0.01) << method << " " << modulus;
      }
    }
  }
}

/// Reactions of constraints and obstacles add up to zero in static equilibrium, to the residual: a capsule
/// pressed into a block, at small and large strains and Poisson's ratio up to 0.49, and in both precisions.
TEST(RestingContact, balances_the_other_reactions) {
  for (const double ratio : {0.3, 0.49}) {
    for (const Precision precision : {Precision::double_precision, Precision::single_precision}) {
      Column block({1.0, 1.0, 0.6}, {8, 8, 5}, NeoHookean{.young_modulus = 3000.0, .poisson_ratio = ratio});
      block.description.displacements = {{"foot", {}}};
      Obstacle tool{
          .label = "tool", .set = "top", .shape = Obstacle::Shape::capsule, .point = {0.5, 0.2, 0.8}};
      tool.end = {0.6, 0.7, 0.82};
      tool.radius = 0.15;
      tool.displacement = {0.0, 0.0, -0.2};
      block.description.forces.of<Obstacle>() = {tool};
      Recorder recorder;
      const Scene scene = block.scene();
      const Relaxation found = relax(Model(scene, {"tl-perturbation", {}, precision}), recorder);
      EXPECT_TRUE(in_equilibrium(found)) << outcome(found, precision);
      const Reactions& reactions = recorder.rows.back().reactions;
      const double size = length(reactions.at("tool"));
      EXPECT_LT(reactions.at("tool")[2], 0.0);
      EXPECT_GT(size, 1.0);
      for (std::size_t i = 0; i < 3; ++i)
        EXPECT_NEAR(reactions.at("tool")[i] + reactions.at("foot")[i], 0.0,
                    (precision == Precision::double_precision ? 1e-6 : 1e-3) * size);
    }
  }
}

/// What is loaded and unloaded again, by a force or by a ball that comes and goes, is undeformed: with no
/// load left, a residual relative to it never fell below a tolerance, and no equilibrium was found.
TEST(RestingContact, leaves_an_unloaded_body) {
  const LoadCurve there_and_back{{0.0, 0.5, 1.0}, {0.0, 1.0, 0.0}};
  for (const auto precision : {Precision::double_precision, Precision::single_precision}) {
    for (const double friction : {-1.0, 0.0, 0.3}) {  // below zero: a force
      Column block({0.1, 0.1, 0.05}, {4, 4, 2}, NeoHookean{.young_modulus = 5e3, .poisson_ratio = 0.45});
      Case& d = block.description;
      d.displacements = {{"foot", {}}};
      if (friction < 0.0) {
        d.forces.of<DeadForce>() = {{.set = "top", .total = {1.0, 0.0, -2.0}, .curve = there_and_back}};
      } else {
        Obstacle tool{
            .label = "tool", .set = "top", .shape = Obstacle::Shape::sphere, .point = {0.05, 0.05, 0.081}};
        tool.radius = 0.03;
        tool.displacement = {0.01, 0.0, -0.01};
        tool.curve = there_and_back;
        tool.friction = friction;
        d.forces.of<Obstacle>() = {tool};
      }
      for (const int levels : {4, 21}) {
        d.relaxation.levels = levels;
        Recorder recorder;
        const Scene scene = block.scene();
        const Relaxation found = relax(Model(scene, {"tl-perturbation", {}, precision}), recorder);
        EXPECT_TRUE(in_equilibrium(found)) << outcome(found, precision);
        double largest = 0.0, left = 0.0;
        for (const Frame& frame : recorder.frames) {
          for (const Vector& u : frame.u) largest = std::max(largest, length(u));
        }
        for (const Vector& u : found.u) left = std::max(left, length(u));
        EXPECT_GT(largest, 1e-3);
        EXPECT_LT(left, (precision == Precision::double_precision ? 1e-9 : 1e-6) * largest)
            << friction << ", " << levels;
      }
    }
  }
}

/// A gap of a body to the ground below the rounding of a file does not decide whether the ground holds it.
TEST(RestingContact, holds_a_body_that_just_fits) {
  for (const double gap : {-1e-16, 0.0, 1e-15, 1e-9}) {
    Column block({1.0, 1.0, 1.0}, {2, 2, 2}, NeoHookean{.young_modulus = 1e5, .poisson_ratio = 0.3});
    for (Vector& X : block.mesh.points) X[2] += gap;
    block.description.displacements = {{"side", {}, {true, false, false}},
                                       {"back", {}, {false, true, false}}};
    block.description.forces.of<Gravity>() = {{{0.0, 0.0, -10.0}}};
    block.description.forces.of<Obstacle>() = {ground()};
    Recorder recorder;
    const Scene scene = block.scene();
    EXPECT_TRUE(relax(Model(scene, {"tl-perturbation"}), recorder).converged) << gap;
    EXPECT_NEAR(recorder.rows.back().reactions.at("ground")[2], 1e4, 1e-3) << gap;
  }
}

/// The weight of a block is carried by the ground that it stands on, although nothing else holds it up.
TEST(RestingContact, carries_a_block_in_equilibrium) {
  Column block({1.0, 1.0, 1.0}, {3, 3, 3}, NeoHookean{.young_modulus = 1e5, .poisson_ratio = 0.3});
  block.description.displacements = {{"side", {}, {true, false, false}}, {"back", {}, {false, true, false}}};
  block.description.forces.of<Gravity>() = {{{0.0, 0.0, -10.0}}};
  block.description.forces.of<Obstacle>() = {ground()};
  Recorder recorder;
  const Scene scene = block.scene();
  const Relaxation found = relax(Model(scene, {"tl-perturbation"}), recorder);
  EXPECT_TRUE(found.converged);
  EXPECT_NEAR(recorder.rows.back().reactions.at("ground")[2], 1e4, 1e-3);
}

}  // namespace
}  // namespace sandglass::verification::resting_contact_test
