/// Simulations that fail: what they go back to, steps that are taken again, refused input.

#include <gtest/gtest.h>

#include <cmath>

#include "base/error.hpp"
#include "mesh/vectors.hpp"
#include "sandglass/simulation.hpp"
#include "support/field_of.hpp"
#include "support/simulated_block.hpp"
#include "support/temporary_folder.hpp"

namespace sandglass::verification::simulation_failure_test {
namespace {

using simulated_block::ball, simulated_block::block, simulated_block::pulled, simulated_block::text_of;

TEST(Simulation, without_equilibrium_it_stays_as_it_was) {
  const std::string impatient = "[relaxation]\nmax_steps = 3\n";
  Simulation<double> simulation(block(), text_of(pulled) + impatient);
  simulation.impose(1.0);
  simulation.advance(0.05);
  const NodalField before = field_of(simulation);
  EXPECT_THROW(simulation.settle(), ComputationError);
  EXPECT_EQ(field_of(simulation), before);
  simulation.advance(0.01);
}

/// Nodes between foot and head move only along z, so that no element can escape sideways.
const std::string guided = pulled +
                           "[sets.inside]\nz = [0.01, 0.19]\n[[displacement]]\nset = \"inside\"\n"
                           "value = [0.0, 0.0, 0.0]\ncomponents = \"xy\"\n";

/// A push that turns elements inside out with steps of any length, or makes steps collapse, ends at a check;
/// the body then returns to its state at the check before.
template <class Real>
void expect_return(const char* method) {
  SCOPED_TRACE(method);
  constexpr double frame = 0.18;  // s
  const Vector gone{0.0, 0.0, -0.5};
  Simulation<Real> simulation(block(), text_of(guided) + "check_interval = 5\n", {.method = method});
  const auto* const before = simulation.displacements().data;
  simulation.move("head", gone);
  std::string message;
  try {
    simulation.advance(frame);
  } catch (const ComputationError& error) {
    message = error.what();
  }
  const double whole = simulation.time();
  ASSERT_GT(whole, 0.0);
  ASSERT_LT(whole, frame);
  EXPECT_PRED_FORMAT2(::testing::IsSubstring, "element ", message);
  EXPECT_PRED_FORMAT2(::testing::IsSubstring, fmt::format("is back at {:.6g} s", whole), message);
  EXPECT_EQ(simulation.displacements().data, before);
  // Driven nodes stay until they get a new target, and the failure leaves no trace.
  const auto node = index(simulation.nodes("head")[0]);
  const Vector head = field_of(simulation)[node];
  EXPECT_NEAR(head[2], gone[2] * whole / frame, 1e-6);  // on a straight path, in single precision
  simulation.advance(0.1 * simulation.step_size());
  EXPECT_EQ(field_of(simulation)[node], head);
  simulation.move("head", {0.0, 0.0, -0.02});
  simulation.settle();
  simulation.advance(0.1);
  for (const Vector& u : field_of(simulation)) EXPECT_LT(length(u), 0.03);
}

TEST(Simulation, returns_to_its_last_whole_state_when_an_element_turns_inside_out) {
  for (const char* method : {"tl-perturbation", "tl-adaptive", "ul-viscous"}) {
    expect_return<double>(method);
    expect_return<float>(method);
  }
}

TEST(Simulation, before_the_first_check_it_returns_to_the_start_or_to_where_it_settled) {
  Simulation<double> simulation(block(), text_of(guided));
  simulation.move("head", {0.0, 0.0, -5.0});  // upside down within the twenty shortest steps too
  EXPECT_THROW(simulation.advance(0.12), ComputationError);
  EXPECT_EQ(simulation.time(), 0.0);
  EXPECT_EQ(field_of(simulation), NodalField(45));
  simulation.move("head", {0.02, 0.01, 0.03});
  simulation.settle();
  const NodalField settled = field_of(simulation);
  simulation.move("head", {0.0, 0.0, -5.0});
  EXPECT_THROW(simulation.advance(0.15), ComputationError);
  EXPECT_EQ(field_of(simulation), settled);
}

/// The head is pressed so fast that elements turn inside out before a check, but not with shorter steps:
/// these replace them, up to the same time and position.
TEST(Simulation, takes_steps_that_prove_too_long_again) {
  for (const auto& [pressed, seconds] : {std::pair{0.09, 0.05}, {0.13, 0.15}}) {
    Simulation<double> simulation(block(), text_of(pulled),
                                  {.method = "tl-mean-dilatation", .step_fraction = 1.0});
    simulation.move("head", {0.0, 0.0, -pressed});
    simulation.advance(seconds);
    simulation.advance(0.1);
    EXPECT_NEAR(simulation.time(), seconds + 0.1, 1e-12);
    EXPECT_EQ(field_of(simulation)[index(simulation.nodes("head")[0])], (Vector{0.0, 0.0, -pressed}));
  }
}

/// Of the case, unless the program chooses it; a time step is the longest.
TEST(Simulation, takes_the_steps_of_the_case) {
  const auto step = [](const std::string& keys, const SimulationSettings& settings) {
    std::string text = text_of(pulled);
    text.insert(text.find("duration"), keys);
    return Simulation<double>(block(), text, settings).step_size();
  };
  const double usual = step("", {});
  EXPECT_EQ(step("", {.step_fraction = 0.9}), usual);
  EXPECT_DOUBLE_EQ(step("", {.step_fraction = 0.45}), 0.5 * usual);
  const std::string half = "step_fraction = 0.45\n";
  EXPECT_DOUBLE_EQ(step(half, {}), 0.5 * usual);
  EXPECT_EQ(step(half, {.step_fraction = 0.9}), usual);
  EXPECT_EQ(step("time_step = 1e-4\n", {}), 1e-4);
  EXPECT_EQ(step("time_step = 10.0\n", {}), usual);
}

TEST(Simulation, refuses_what_makes_no_sense) {
  using ::testing::IsSubstring;
  Simulation<double> simulation(block(), text_of(pulled + "[sets.side]\nx = [0.1, 0.1]\ny = [0.05, 0.05]\n"
                                                          "z = [0.05, 0.15]\n"));
  const auto says = [](const std::string& part, const std::string& text) {
    EXPECT_PRED_FORMAT2(IsSubstring, part, text);
  };
  const Vector up{0.0, 0.0, 0.01};
  says("did you mean 'head'", input_error([&] { simulation.move("haed", up); }));
  says("imposes no displacement", input_error([&] { simulation.move("side", up); }));
  says("imposes no displacement", input_error([&] { simulation.reaction("side"); }));
  says("is not known", input_error([&] { simulation.nodes("haed"); }));
  says("one for each of its 9 nodes", input_error([&] { simulation.move("head", std::vector<Vector>(8)); }));
  says("must be in", input_error([&] { simulation.move("head", {0.0, std::nan(""), 0.0}); }));
  says("must be in", input_error([&] { simulation.impose(std::nan("")); }));
  for (const double seconds : {0.0, -1.0, std::nan("")}) {
    says("seconds", input_error([&] { simulation.advance(seconds); }));
  }
  Simulation<double> touched(block(), text_of(ball("penalty")));
  says("obstacle 'ball': 2 displacements",
       input_error([&] { touched.move("ball", std::vector<Vector>(2)); }));
  says("did you mean 'ball'", input_error([&] { touched.move("bal", up); }));
  says("did you mean 'ball'", input_error([&] { touched.moment("bal"); }));
  const auto made = [](const SimulationSettings& settings) {
    return input_error([&] { Simulation<double>(block(), text_of(pulled), settings); });
  };
  says("step_fraction", made({.step_fraction = 1.5}));
  says("damping", made({.damping = -1.0}));
  says("threads", made({.threads = 0}));
  says("'tl-nothing' is not known", made({.method = "tl-nothing"}));
  says("no dynamics", made({.method = "linear-condensed"}));
}

TEST(Simulation, refuses_meshes_that_are_none) {
  using ::testing::IsSubstring;
  const auto refused = [](const std::string& part, const auto& spoil, const std::string& text) {
    MeshArrays mesh = block();
    spoil(mesh);
    EXPECT_PRED_FORMAT2(IsSubstring, part, input_error([&] { Simulation<double>(mesh, text); }));
  };
  const std::string text = text_of(pulled);
  refused(
      "cell 3 names node 45; it must be in [0, 45)", [](auto& mesh) { mesh.cells[3][2] = 45; }, text);
  refused(
      "set 'head' names node -1", [](auto& mesh) { mesh.sets["head"][0] = -1; }, text);
  refused(
      "node 45 of 46 belongs to no cell", [](auto& mesh) { mesh.points.push_back({}); }, text);
  refused(
      "belongs to no cell", [](auto& mesh) { mesh = {}; }, text);
  refused(
      "inverted", [](auto& mesh) { std::swap(mesh.cells[0][0], mesh.cells[0][1]); }, text);
  refused(
      "node 0 is at nan", [](auto& mesh) { mesh.points[0][0] = std::nan(""); }, text);
  const auto same = [](auto&) {};
  refused("mesh is not allowed here", same, text + "[mesh]\ngenerator = \"box\"\n");
  refused("case text:", same, text + "[meterial]\n");
  refused("is not TOML", same, "[case");
}

}  // namespace
}  // namespace sandglass::verification::simulation_failure_test
