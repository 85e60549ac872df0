// Bodies in a batch move as each would alone.
#include "sandglass/batch.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <map>

#include "assembly/method_entry.hpp"
#include "solve/steady_step.hpp"
#include "support/scenes.hpp"
#include "support/temporary_folder.hpp"
#include "support/typed_lists.hpp"

namespace sandglass::verification::batch_test {
namespace {

constexpr double step = 1e-3;  // s; stable for all bodies below
constexpr int steps = 100;

/// A block of two materials on a fixed foot, damped, with an initial velocity. Its head is driven, and a
/// force with a load curve of its own pushes its side.
std::string text_with(const std::array<std::string, 2>& materials) {
  return std::string(
             "[case]\nname = \"block\"\nrequirement = \"A block is moved.\"\nanswer = \"dynamic\"\n") +
         "[[materials]]\nelements = \"low\"\n" + materials[0] + "[[materials]]\n" + materials[1] +
         "[element_sets]\nlow = { z = [0.0, 0.1] }\n"
         "[sets]\nfoot = { z = [0.0, 0.0] }\nside = { x = [0.1, 0.1] }\nmiddle = { z = [0.1, 0.1] }\n"
         "[[displacement]]\nset = \"foot\"\nvalue = [0.0, 0.0, 0.0]\n"
         "[[displacement]]\nset = \"head\"\nvalue = [0.02, 0.0, 0.03]\ncomponents = \"xz\"\n"
         "[[force]]\nset = \"side\"\ntotal = [0.05, 0.0, 0.0]\n"
         "[[force]]\nset = \"side\"\ntotal = [0.0, 0.02, 0.0]\ntimes = [0.0, 0.05]\nfactors = "
         "[0.5, 1.5]\n"
         "[[velocity]]\nvalue = [0.0, 0.1, 0.0]\n"
         "[dynamics]\nduration = 0.2\ndamping = 3.0\n";
}

std::string text_of(double stiffness, const std::string& law = "neo-hookean") {
  const auto material = [&](double modulus) {
    const std::string E = std::to_string(stiffness * modulus);
    return "law = \"" + law + "\"\ndensity = 1000.0\n" +
           (law == "neo-hookean" ? "young_modulus = " + E + "\npoisson_ratio = 0.45\n"
                                 : "c1 = " + E + "\nc2 = " + E + "\nc3 = 0.0\nbulk_modulus = " + E + "0\n");
  };
  return text_with({material(2000.0), material(1000.0)});
}

MeshArrays block(bool skewed) {
  Mesh mesh = box({0.1, 0.1, 0.2}, {2, 2, 4});
  for (Vector& X : mesh.points) {  // nodes in sets of the case stay
    if (skewed && X[0] > 0.01 && X[0] < 0.09 && X[2] > 0.01 && X[2] < 0.19) X[1] += 0.1 * X[0] * X[1];
  }
  return {mesh.points,
          mesh.cells,
          {{"head", nodes_where(mesh.points, [](const Vector& X) { return X[2] > 0.19; })}}};
}

/// The stiffness of body b, its load factor and the path of its head.
double stiffness_of(std::size_t b) {
  return 0.5 + 0.1 * static_cast<double>(b);
}
double factor_of(std::size_t b) {
  return 0.2 + 0.05 * static_cast<double>(b);
}
Vector head_of(std::size_t b) {
  return {1e-3 * static_cast<double>(b), 0.0, 0.01 - 2e-3 * static_cast<double>(b)};
}

/// The largest distance between the bodies of a batch and simulations of each, over 0.03 m, and between the
/// forces on their heads, over the largest.
template <class Real>
std::pair<double, double> distance_from_simulations(bool skewed, const std::string& law,
                                                    const SimulationSettings& settings) {
  constexpr std::size_t bodies = 2 * native_width<Real> + 3;  // the last pack is not full
  Batch<Real> batch(block(skewed), text_of(1.0, law), bodies, settings);
  std::vector<Simulation<Real>> alone;
  for (std::size_t b = 0; b < bodies; ++b) {
    batch.scale_stiffness(b, stiffness_of(b));
    alone.emplace_back(block(skewed), text_of(stiffness_of(b), law), settings);
  }
  for (int n = 1; n <= steps; ++n) {
    for (std::size_t b = 0; b < bodies; ++b) {
      const double share = static_cast<double>(n) / steps;
      const Vector head{share * head_of(b)[0], 0.0, share * head_of(b)[2]};
      batch.impose(b, share * factor_of(b));
      batch.move(b, "head", head);
      alone[b].impose(share * factor_of(b));
      alone[b].move("head", head);
      alone[b].advance(step);
      EXPECT_LT(step, std::min(batch.step_size(), alone[b].step_size()));
    }
    batch.advance(step);
  }
  double apart = 0.0, forces_apart = 0.0, largest_force = 0.0;
  for (std::size_t b = 0; b < bodies; ++b) {
    const NodalView<Real> u = alone[b].displacements();
    const auto rows = alone[b].row_of_node();
    for (std::size_t node = 0; node < rows.size(); ++node) {
      for (std::size_t i = 0; i < 3; ++i) {
        const double difference =
            batch.displacement(b, node)[i] - static_cast<double>(u[index(rows[node])][i]);
        apart = std::max(apart, std::abs(difference) / 0.03);
      }
    }
    const auto one = batch.reaction(b, "head"), other = alone[b].reaction("head");
    for (std::size_t i = 0; i < 3; ++i) {
      forces_apart = std::max(forces_apart, std::abs(one[i] - other[i]));
      largest_force = std::max(largest_force, std::abs(other[i]));
    }
    EXPECT_NEAR(batch.time(), alone[b].time(), 1e-14);
  }
  return {apart, forces_apart / largest_force};
}

struct Setting {
  const char* method;
  bool skewed;
  const char* law;
};

class BatchTest : public ::testing::TestWithParam<Setting> {};

// Both take 100 equal steps, but sum forces in another order, and the batch multiplies by the stiffness
// afterwards. A force is a sum of 24 numbers at a node; its rounding displaces a node by at most that share
// of the motion, and grows at most with the square of the steps. Other mistakes change the first digits.
TEST_P(BatchTest, bodies_move_as_each_would_alone) {
  const auto& [method, skewed, law] = GetParam();
  constexpr double growth = 24.0 * steps * steps;
  const auto [u, force] = distance_from_simulations<double>(skewed, law, {.method = method});
  EXPECT_LT(u, growth * 0x1p-53);
  EXPECT_LT(force, 10.0 * growth * 0x1p-53);
}

// In single precision that bound would be .014, too wide to reveal a mistake. Roundings have both signs and
// partly cancel, so the bound here grows with the number of steps, not with its square.
TEST_P(BatchTest, in_single_precision_too) {
  const auto& [method, skewed, law] = GetParam();
  const auto [u, force] = distance_from_simulations<float>(skewed, law, {.method = method});
  EXPECT_LT(u, 24.0 * steps * 0x1p-24);
  EXPECT_LT(force, 240.0 * steps * 0x1p-24);
}

INSTANTIATE_TEST_SUITE_P(Methods, BatchTest,
                         ::testing::Values(Setting{"tl-perturbation", false, "neo-hookean"},
                                           Setting{"tl-perturbation", true, "neo-hookean"},
                                           Setting{"tl-perturbation", true, "yeoh"},
                                           Setting{"tl-mean-dilatation", true, "neo-hookean"},
                                           Setting{"tl-mean-dilatation", false, "yeoh"}));

/// The parameters of a law in a material of a body: those of the sample, each moved by its own share.
template <class Law>
std::map<std::string, double> parameters_of(std::size_t material, std::size_t body) {
  std::map<std::string, double> all;
  const double E = material == 0 ? 2000.0 : 1000.0;
  double share = 0.01;
  std::apply(
      [&](const auto&... p) {
        ((all[std::string(p.name)] = sample_value(p.name, p.unit, p.range, E, 0.45) *
                                     (1.0 + (share += 0.005) * static_cast<double>(body % 5))),
         ...);
      },
      Law::parameters());
  return all;
}

/// The case of a body whose materials have this law.
template <class Law>
std::string text_of_body(std::size_t body) {
  std::array<std::string, 2> materials;
  for (std::size_t m = 0; m < 2; ++m) {
    materials[m] = fmt::format("law = \"{}\"\ndensity = 1000.0\n", Law::name);
    for (const auto& [name, value] : parameters_of<Law>(m, body))
      materials[m] += fmt::format("{} = {}\n", name, value);
  }
  return text_with(materials);
}

/// The largest distance between bodies of a batch with their own parameters and simulations of each, over
/// 0.03 m.
template <class Real, class Law>
double distance_with_parameters(bool skewed, const char* method) {
  constexpr std::size_t bodies = native_width<Real> + 3;
  const SimulationSettings settings{.method = method};
  Batch<Real> batch(block(skewed), text_of_body<Law>(0), bodies, settings);
  std::vector<std::map<std::string, std::vector<double>>> parameters(2);
  std::vector<Simulation<Real>> alone;
  double shortest = INFINITY;
  for (std::size_t b = 0; b < bodies; ++b) {
    for (std::size_t m = 0; m < 2; ++m)
      for (const auto& [name, value] : parameters_of<Law>(m, b)) parameters[m][name].push_back(value);
    alone.emplace_back(block(skewed), text_of_body<Law>(b), settings);
    shortest = std::min(shortest, alone.back().step_size());
  }
  const double of_case = batch.step_size();
  batch.set_parameters(parameters);
  const double longest = std::min(of_case, shortest / SteadyStep::first_share);
  EXPECT_NEAR(batch.step_size(), longest, 1e-5 * longest);  // rounding of float
  EXPECT_LT(step, shortest);
  for (int n = 1; n <= steps; ++n) {
    for (std::size_t b = 0; b < bodies; ++b) {
      const double share = static_cast<double>(n) / steps;
      batch.move(b, "head", {0.01 * share, 0.0, 0.01 * share});
      alone[b].move("head", {0.01 * share, 0.0, 0.01 * share});
      alone[b].advance(step);
    }
    batch.advance(step);
  }
  double apart = 0.0, others_apart = 0.0;
  for (std::size_t b = 0; b < bodies; ++b) {
    const NodalView<Real> u = alone[b].displacements();
    const auto rows = alone[b].row_of_node();
    for (std::size_t node = 0; node < rows.size(); ++node) {
      for (std::size_t i = 0; i < 3; ++i) {
        const double found = batch.displacement(b, node)[i];
        apart = std::max(apart, std::abs(found - static_cast<double>(u[index(rows[node])][i])) / 0.03);
        others_apart = std::max(others_apart, std::abs(found - batch.displacement(0, node)[i]) / 0.03);
      }
    }
  }
  EXPECT_GT(others_apart, 1e-4) << Law::name;  // what one set of numbers for all would miss
  return apart;
}

template <class Law>
class BatchOfLaw : public ::testing::Test {};

/// The laws that batches take.
template <class... Laws>
auto isotropic(TypeList<Laws...> /*all*/) {
  return Concatenated<TypeList<>, std::conditional_t<is_isotropic<Laws>, TypeList<Laws>, TypeList<>>...>{};
}
using IsotropicTypes = detail::AsTestTypes<decltype(isotropic(ElasticLaws{}))>::type;
TYPED_TEST_SUITE(BatchOfLaw, IsotropicTypes, EntryName);

// Tolerances as above. Bodies differ in every parameter of both materials.
TYPED_TEST(BatchOfLaw, bodies_have_parameters_of_their_own) {
  for (const MethodEntry& entry : methods()) {
    if (entry.packed_double.assemble_batch == nullptr) continue;
    const char* const method = entry.name.data();
    for (const bool skewed : {false, true}) {
      EXPECT_LT((distance_with_parameters<double, TypeParam>(skewed, method)),
                24.0 * steps * steps * 0x1p-53);
      EXPECT_LT((distance_with_parameters<float, TypeParam>(skewed, method)), 24.0 * steps * 0x1p-24);
    }
  }
}

// What is not given stays, and the numbers of the case give its bodies again.
TEST(Batch, parameters_replace_those_of_the_case) {
  Batch<double> batch(block(false), text_of(1.0), 3), other(block(false), text_of(1.0), 3);
  const double of_case = batch.step_size();
  using Parameters = std::vector<std::map<std::string, std::vector<double>>>;
  batch.set_parameters(Parameters{{}, {{"young_modulus", {500.0, 600.0, 700.0}}}});
  EXPECT_NEAR(batch.step_size(), of_case, 1e-12 * of_case);  // the first material is stiffer
  batch.set_parameters(Parameters{{{"young_modulus", {2000.0, 8000.0, 100.0}}}, {}});
  EXPECT_NEAR(batch.step_size(), of_case / SteadyStep::first_share / 2.0, 1e-12 * of_case);
  batch.set_parameters(Parameters{{{"young_modulus", {2000.0, 2000.0, 2000.0}}},
                                  {{"young_modulus", {1000.0, 1000.0, 1000.0}}}});
  for (Batch<double>* each : {&batch, &other}) {
    for (int n = 1; n <= 20; ++n) {
      each->move(1, "head", {0.0, 0.0, 5e-4 * n});
      each->advance(step);
    }
  }
  for (std::size_t node = 0; node < 45; ++node) {
    for (std::size_t i = 0; i < 3; ++i)
      EXPECT_NEAR(batch.displacement(1, node)[i], other.displacement(1, node)[i], 1e-12);
  }
  const auto refused = [&](const Parameters& given) {
    return input_error([&] { batch.set_parameters(given); });
  };
  EXPECT_NE(refused({{}}).find("1 were given; it must be one for each of the 2"), std::string::npos);
  EXPECT_EQ(
      refused({{{"c1", {1.0, 2.0, 3.0}}}, {}}),
      "material 0, body 0: 'c1' is not a parameter of 'neo-hookean'; allowed: young_modulus, poisson_ratio");
  EXPECT_EQ(refused({{}, {{"young_modulus", {1.0, -2.0, 3.0}}}}),
            "material 1, body 1: young_modulus = -2 must be in (0, inf)");
  EXPECT_EQ(refused({{{"young_modulus", {1.0}}}, {}}),
            "material 0: young_modulus has 1 values; it must be one for each of the 3 bodies");
  Batch<double> yeoh(block(false), text_of(1.0, "yeoh"), 2);
  EXPECT_NE(input_error([&] {
              yeoh.set_parameters(Parameters{{{"c2", {1.0, -900.0}}}, {}});
            }).find("material 0, body 1: c2 = -900 must be at least 0, or c2^2 less than"),
            std::string::npos);
}

// Frames of many steps, each with a newly chosen step.
TEST(Batch, driven_nodes_and_forces_go_straight) {
  Batch<double> batch(block(true), text_of(1.0), 9);
  Simulation<double> alone(block(true), text_of(1.0));
  for (const double end : {0.5, 1.0}) {
    for (std::size_t b = 0; b < 9; ++b) batch.impose(b, end);
    alone.impose(end);
    batch.advance(0.1);
    alone.advance(0.1);
  }
  const NodalView<double> u = alone.displacements();
  for (std::size_t node = 0; node < 45; ++node) {
    for (std::size_t i = 0; i < 3; ++i) {
      // About 60 steps; steps chosen from bounds of the same elements differ only by rounding.
      EXPECT_NEAR(batch.displacement(8, node)[i], u[index(alone.row_of_node()[node])][i], 1e-11);
    }
  }
}

TEST(Batch, bits_do_not_depend_on_threads) {
  const auto moved = [](int threads) {
    Batch<double> batch(block(true), text_of(1.0), 19, {.threads = threads});
    for (std::size_t b = 0; b < 19; ++b) batch.move(b, "head", head_of(b));
    batch.advance(0.05);
    std::vector<Vector> u;
    for (std::size_t b = 0; b < 19; ++b) u.push_back(batch.displacement(b, 20));
    return u;
  };
  EXPECT_EQ(moved(1), moved(2));
}

TEST(Batch, the_step_is_that_of_the_stiffest_body) {
  Batch<double> batch(block(false), text_of(1.0), 10);
  const double as_the_case = batch.step_size();
  EXPECT_NEAR(as_the_case, Simulation<double>(block(false), text_of(1.0)).step_size(), 1e-12 * as_the_case);
  batch.scale_stiffness(9, 4.0);
  const double longest = as_the_case / SteadyStep::first_share;
  EXPECT_NEAR(batch.step_size(), longest / 2.0, 1e-12 * longest);
}

// As in Simulation, the step becomes shorter when one body is pressed to half its height.
TEST(Batch, the_step_shortens_as_one_body_stiffens) {
  Batch<double> batch(block(false), text_of(1.0), 10, {.damping = 15.0});
  Simulation<double> alone(block(false), text_of(1.0), {.damping = 15.0});
  const double undeformed_step = batch.step_size() / SteadyStep::first_share;
  batch.move(7, "head", {0.0, 0.0, -0.08});
  alone.move("head", {0.0, 0.0, -0.08});
  batch.advance(1.0);
  alone.advance(1.0);
  EXPECT_LT(batch.step_size(), 0.9 * undeformed_step);
  EXPECT_NEAR(batch.step_size(), alone.step_size(), 0.02 * undeformed_step);
}

// One element, all of whose nodes are driven, is pressed to 1/2500 of its height. Its volumetric energy grows
// without limit, so that its stable step becomes shorter still.
TEST(Batch, a_body_whose_step_collapses_is_named) {
  const Mesh mesh = box({0.1, 0.1, 0.1}, {1, 1, 1});
  const std::string material =
      "law = \"neo-hookean\"\ndensity = 1000.0\nyoung_modulus = 1000.0\npoisson_ratio = 0.3\nvolumetric = "
      "\"logarithmic\"\n";
  Batch<double> batch(
      {mesh.points, mesh.cells, {}},
      "[case]\nname = \"one\"\nrequirement = \"It is pressed.\"\nanswer = \"dynamic\"\n[material]\n" +
          material +
          "[sets]\nfoot = { z = [0.0, 0.0] }\nhead = { z = [0.1, 0.1] }\n"
          "[[displacement]]\nset = \"foot\"\nvalue = [0.0, 0.0, 0.0]\n"
          "[[displacement]]\nset = \"head\"\nvalue = [0.0, 0.0, 0.0]\n[dynamics]\nduration = 0.2\n",
      10);
  batch.move(7, "head", {0.0, 0.0, -0.09996});
  try {
    batch.advance(1.0);
    FAIL();
  } catch (const ComputationError& error) {
    EXPECT_NE(std::string(error.what()).find("body 7 allows"), std::string::npos) << error.what();
  }
}

TEST(Batch, an_inverted_body_is_named) {
  Batch<double> batch(block(false), text_of(1.0), 12);
  batch.move(9, "head", {0.0, 0.0, -0.5});
  try {
    batch.advance(0.2);
    FAIL() << "an element is inverted";
  } catch (const ComputationError& error) {
    EXPECT_NE(std::string(error.what()).find("body 9"), std::string::npos) << error.what();
  }
}

TEST(Batch, unsupported_features_are_refused) {
  const auto with = [](const std::string& more, const SimulationSettings& settings = {}) {
    return input_error([&] { Batch<double>(block(false), text_of(1.0) + more, 3, settings); });
  };
  EXPECT_NE(with("", {.method = "ul-perturbation"}).find("choose one of tl-perturbation, tl-mean-dilatation"),
            std::string::npos);
  EXPECT_NE(with("subcycles = 4\n").find("subcycles = 1"), std::string::npos);
  EXPECT_NE(with("body_frequency = 1\n").find("body_frequency = 0"), std::string::npos);
  EXPECT_NE(with("[[pressure]]\nset = \"side\"\nvalue = 1.0\n").find("remove [[pressure]]"),
            std::string::npos);
  Batch<double> batch(block(false), text_of(1.0), 3);
  EXPECT_EQ(input_error([&] { batch.impose(3, 1.0); }), "body = 3 must be below 3");
  EXPECT_EQ(input_error([&] { batch.displacement(0, 45); }), "node = 45 must be below 45");
  EXPECT_NE(input_error([&] { batch.scale_stiffness(0, 0.0); }).find("factor = 0"), std::string::npos);
  EXPECT_NE(input_error([&] { Batch<double>(block(false), text_of(1.0), 0); }).find("bodies = 0"),
            std::string::npos);
  EXPECT_NE(input_error([&] { batch.move(0, "middle", Vector{}); }).find("no driven node"),
            std::string::npos);
}

}  // namespace
}  // namespace sandglass::verification::batch_test
