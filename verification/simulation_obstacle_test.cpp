/// Rigid obstacles in simulations: how they move, forces and moments, equilibrium.

#include <gtest/gtest.h>

#include "mesh/vectors.hpp"
#include "sandglass/simulation.hpp"
#include "support/case_text.hpp"
#include "support/field_of.hpp"
#include "support/simulated_block.hpp"
#include "support/temporary_folder.hpp"

namespace sandglass::verification::simulation_obstacle_test {
namespace {

using simulated_block::ball, simulated_block::block, simulated_block::text_of;

/// Friction and inertia make the force depend on the path; both are the same to rounding, which contact
/// amplifies.
TEST(Simulation, moves_obstacles_as_their_paths_in_the_case_do) {
  for (const char* method : {"penalty", "kinematic"}) {
    Simulation<double> by_program(block(), text_of(ball(method) + "friction = 0.3\n"));
    Simulation<double> by_case(
        block(),
        text_of(
            ball(method) +
            "friction = 0.3\ndisplacement = [0.01, 0.0, -0.02]\ntimes = [0.0, 0.1]\nfactors = [0.0, 1.0]\n"));
    by_program.move("ball", {0.01, 0.0, -0.02});
    TemporaryFolder folder;
    by_program.save(folder / "before");
    for (int again = 0; again < 2; ++again) {
      by_program.advance(0.1);
      if (again == 0) by_case.advance(0.1);
      EXPECT_GT(length(by_case.reaction("ball")), 0.01);
      EXPECT_LT(distance(by_program.reaction("ball"), by_case.reaction("ball")), 1e-9) << method;
      EXPECT_LT(distance(by_program.moment("ball"), by_case.moment("ball")), 1e-11) << method;
      EXPECT_LT(largest_distance(field_of(by_program), field_of(by_case)), 1e-12) << method;
      by_program.resume(folder / "before");
    }
  }
}

/// The two ends of a capsule are the same obstacle with another point: moments differ by that of the force. A
/// ball without friction has none about its centre.
TEST(Simulation, the_moment_of_an_obstacle_is_about_its_point) {
  const std::string rod =
      "[[obstacle]]\nname = \"rod\"\nset = \"head\"\nshape = \"capsule\"\nradius = 0.05\nmethod = ";
  const auto pressed = [&](const std::string& method, const std::string& ends) {
    Simulation<double> simulation(block(), text_of(rod + "\"" + method + "\"\n" + ends));
    simulation.move("rod", {0.01, 0.0, -0.02});
    simulation.advance(0.1);
    return simulation;
  };
  for (const char* method : {"penalty", "kinematic"}) {
    const auto forth = pressed(method, "point = [0.02, 0.04, 0.25]\nend = [0.09, 0.04, 0.30]\n"),
               back = pressed(method, "point = [0.09, 0.04, 0.30]\nend = [0.02, 0.04, 0.25]\n");
    const Vector force = forth.reaction("rod"), way{0.07, 0.0, 0.05};
    EXPECT_GT(length(force), 0.01) << method;
    const Vector expected = sum(back.moment("rod"), 1.0, cross(way, force));
    EXPECT_LT(distance(forth.moment("rod"), expected), 1e-9) << method;
    EXPECT_GT(length(back.moment("rod")), 1e-4) << method;
  }
  const Simulation<double> round = [] {
    Simulation<double> simulation(block(), text_of(ball("penalty")));
    simulation.move("ball", {0.01, 0.0, -0.02});
    simulation.advance(0.1);
    return simulation;
  }();
  EXPECT_GT(length(round.reaction("ball")), 0.01);
  EXPECT_LT(length(round.moment("ball")), 1e-15);
}

TEST(Simulation, settles_under_an_obstacle_that_it_moved) {
  Simulation<double> by_program(block(), text_of(ball("penalty")));
  Simulation<double> by_case(block(), text_of(ball("penalty") + "displacement = [0.0, 0.0, -0.02]\n"));
  for (Simulation<double>* one : {&by_program, &by_case}) {
    if (one == &by_program)
      one->move("ball", {0.0, 0.0, -0.02});
    else
      one->impose(1.0);
    one->settle();
  }
  EXPECT_GT(length(by_case.reaction("ball")), 0.01);
  EXPECT_LT(distance(by_program.reaction("ball"), by_case.reaction("ball")), 1e-9);
  EXPECT_LT(distance(by_program.moment("ball"), by_case.moment("ball")), 1e-11);
  EXPECT_LT(largest_distance(field_of(by_program), field_of(by_case)), 1e-12);
  for (Simulation<double>* one : {&by_program, &by_case}) one->advance(0.05);  // the ball stays where it is
  EXPECT_LT(largest_distance(field_of(by_program), field_of(by_case)), 1e-12);
}

/// A simulation reports the force of an obstacle by its name; it moves with the factor. At rest the obstacle
/// acts by its penalty, whatever the method of motions; the body hardly moves when it is released.
TEST(Contact, is_part_of_a_simulation) {
  const TemporaryFolder folder;
  const auto path = folder.write(
      "pressed.toml",
      replaced(box_case("pressed", "[1.0, 1.0, 1.0]", "[2, 2, 2]"), "\"quasi-static\"", "\"dynamic\"") +
          "[sets]\nfoot = { z = [0.0, 0.0] }\ntop = { z = [1.0, 1.0] }\n\n[[displacement]]\nset = "
          "\"foot\"\nvalue = [0.0, 0.0, 0.0]\n\n[[obstacle]]\nname = \"plate\"\nset = \"top\"\nshape = "
          "\"plane\"\npoint = [0.0, 0.0, 1.0]\nnormal = [0.0, 0.0, -1.0]\ndisplacement = [0.0, 0.0, "
          "-0.1]\n\n[dynamics]\nduration = 1.0\n");
  Simulation<double> simulation(path, {.damping = 20.0});
  simulation.impose(1.0);
  simulation.advance(1.0);
  EXPECT_LT(simulation.reaction("plate")[2], -10.0);
  simulation.settle();
  const double at_rest = simulation.reaction("foot")[2];
  EXPECT_NEAR(simulation.reaction("plate")[2], -at_rest, 1e-6 * at_rest);
  simulation.advance(0.5);
  EXPECT_NEAR(simulation.reaction("plate")[2], -at_rest, 0.02 * at_rest);
}

/// A simulation of a static case moves as that of a dynamic one: the forces of static equilibrium limit no
/// step, and push by a penalty whatever the method.
TEST(Contact, moves_in_a_simulation_of_a_static_case) {
  const TemporaryFolder folder;
  for (const std::string method : {"penalty", "kinematic"}) {
    const auto after = [&](const std::string& answer) {
      const auto path = folder.write(
          answer + method + ".toml",
          replaced(box_case("pressed", "[1.0, 1.0, 1.0]", "[2, 2, 2]"), "quasi-static", answer) +
              "[sets]\nfoot = { z = [0.0, 0.0] }\ntop = { z = [1.0, 1.0] }\n\n[[displacement]]\nset = "
              "\"foot\"\nvalue = [0.0, 0.0, 0.0]\n\n[[obstacle]]\nname = \"plate\"\nset = \"top\"\n"
              "shape = \"plane\"\npoint = [0.0, 0.0, 1.0]\nnormal = [0.0, 0.0, -1.0]\ndisplacement = "
              "[0.0, 0.0, -0.1]\nmethod = \"" +
              method + "\"\n" + (answer == "dynamic" ? "\n[dynamics]\nduration = 1.0\n" : ""));
      Simulation<double> simulation(path, {.damping = 20.0});
      simulation.impose(1.0);
      simulation.advance(1.0);
      return field_of(simulation);
    };
    EXPECT_EQ(after("quasi-static"), after("dynamic")) << method;
  }
}

}  // namespace
}  // namespace sandglass::verification::simulation_obstacle_test
