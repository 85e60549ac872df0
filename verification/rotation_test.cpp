/// Rotating node sets: positions, velocities, work, and messages about invalid ones.

#include <gtest/gtest.h>

#include <numbers>

#include "base/error.hpp"
#include "io/case_file.hpp"
#include "solve/body.hpp"
#include "solve/central_difference.hpp"
#include "solve/relaxation.hpp"
#include "solve/stable_step.hpp"
#include "support/case_text.hpp"
#include "support/method_test.hpp"
#include "support/random_hexahedra.hpp"
#include "support/scenes.hpp"
#include "support/temporary_folder.hpp"

namespace sandglass::verification::rotation_test {
namespace {

constexpr double pi = std::numbers::pi;
const Vector oblique{2.0 / 3.0, -1.0 / 3.0, 2.0 / 3.0};

Vector cross_product(const Vector& a, const Vector& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

/// Rodrigues: R X with R = 1 + sin A + (1 - cos) A A, A v = axis x v.
Vector turned(const Vector& X, const Vector& axis, double angle) {
  const Vector once = cross_product(axis, X), twice = cross_product(axis, once);
  Vector x = X;
  for (std::size_t i = 0; i < 3; ++i) x[i] += std::sin(angle) * once[i] + (1.0 - std::cos(angle)) * twice[i];
  return x;
}

/// A distorted block on its foot, or with every node in the set "all".
Scene turned_block(const ImposedRotation& rotation, bool held = true) {
  Case description = plain_case(sample_law<NeoHookean>(0.45));
  Mesh mesh = box({0.1, 0.1, 0.2}, {2, 2, 4});
  const NodeSets sets{{"foot", nodes_where(mesh.points, [](const Vector& X) { return X[2] == 0.0; })},
                      {"head", nodes_where(mesh.points, [](const Vector& X) { return X[2] > 0.19; })},
                      {"all", nodes_where(mesh.points, [](const Vector&) { return true; })}};
  RandomGeometry random(5);
  for (auto& X : mesh.points) {
    for (auto& x : X) x += random.uniform(-0.005, 0.005);
  }
  if (held) description.displacements = {{"foot", {}}};
  description.rotations = {rotation};
  return make_scene(description, mesh, sets);
}

/// At every factor, nodes are on their circles, shifted along the displacement; for more than a full turn and
/// backwards too. A straight path to the end, or a rotation about the origin instead of the center, is
/// elsewhere.
TEST(Rotation, nodes_stay_on_their_circles) {
  const Vector center{0.03, -0.02, 0.01}, beside{0.05, 0.02, -0.01};
  for (const double angle : {0.3, -2.0, 2 * pi, 9.0}) {
    const Scene scene = turned_block(
        {.set = "all", .axis = oblique, .angle = angle, .center = center, .displacement = beside}, false);
    const Model model(scene, {"tl-perturbation", {}});
    const auto& elements = *std::get<std::unique_ptr<InternalForce<double>>>(model.internal_force());
    Body<double> body(model, elements);
    for (const double factor : {0.1, 0.5, 0.77, 1.0, 0.25}) {
      const Rows<double> before = body.state().u;
      body.impose(factor);
      const NodalField u = body.field(body.state().u);
      for (std::size_t n = 0; n < u.size(); ++n) {
        const Vector& X = scene.mesh.points[n];
        Vector arm{};
        for (std::size_t i = 0; i < 3; ++i) arm[i] = X[i] - center[i];
        const Vector there = turned(arm, oblique, factor * angle);
        // Coordinates up to 0.2 m and angles up to 9 rad, with relative roundoff of 1e-16.
        for (std::size_t i = 0; i < 3; ++i) {
          EXPECT_NEAR(X[i] + u[n][i], center[i] + there[i] + factor * beside[i], 2e-15);
        }
      }
    }
  }
}

/// By default the center is the mean of the nodes; a rotation about another point also shifts the set.
TEST(Rotation, center_is_the_mean_of_the_nodes) {
  const Scene scene = turned_block({.set = "head", .axis = {0, 0, 1}, .angle = 2.0});
  Vector sum{}, moved{};
  for (const auto& c : scene.constraints) {
    sum[index(c.component)] += final_value(scene, c);
    moved[index(c.component)] += std::abs(final_value(scene, c));
  }
  EXPECT_GT(moved[0], 0.1);
  for (const double component : sum) EXPECT_NEAR(component, 0.0, 1e-15);
}

/// The unit of errors is the largest distance on the path: the diameter after half a turn, also if the path
/// ends at its start; the largest speed is radius times angle.
TEST(Rotation, largest_imposed_is_that_of_the_way) {
  for (const double angle : {0.5, pi / 2, pi, 2 * pi, -2 * pi}) {
    Case description = plain_case(sample_law<NeoHookean>(0.45));
    const Mesh mesh = box({0.1, 0.1, 0.1}, {1, 1, 1});
    const NodeSets sets{{"head", nodes_where(mesh.points, [](const Vector& X) { return X[2] > 0.09; })}};
    description.rotations = {
        {.set = "head", .axis = {0, 0, 1}, .angle = angle, .displacement = {0, 0, 0.02}}};
    const Scene scene = make_scene(description, mesh, sets);
    const double r = 0.05 * std::sqrt(2.0), turn = std::min(std::abs(angle), pi);
    EXPECT_NEAR(largest_imposed(scene), 0.02 + 2 * r * std::sin(turn / 2), 1e-16);
    EXPECT_NEAR(fastest_imposed(scene), 0.02 + r * std::abs(angle), 1e-15);
  }
}

class RotationTest : public MethodTest {};
INSTANTIATE_TEST_SUITE_P(, RotationTest, each_of(SteppedMethods{}), method_label);

/// A body that turns as a whole, more than a full turn, stores no energy and needs no work. In small-strain
/// theory it has a strain of (1 - cos) in the plane of rotation.
TEST_P(RotationTest, rigid_rotation_needs_neither_force_nor_work) {
  const Scene scene = turned_block({.set = "all", .axis = oblique, .angle = 7.0}, false);
  const Model model(scene, choice());
  Recorder recorder;
  const Relaxation answer = relax(model, recorder);
  const auto& law = std::get<NeoHookean>(scene.materials.list.front().law);
  const double stiffness = law.bulk_modulus() * 0.1 * 0.1 * 0.2;  // J at a strain of one
  const double energy = answer.energies.strain + answer.energies.hourglass;
  const double work = recorder.rows.back().external_work;
  if (!method.is_linear) {
    // Strains are rounded to 1e-15, energies to the square of that, up to the rounding of 1 + strain.
    EXPECT_LT(std::abs(energy), 1e-14 * stiffness);
    EXPECT_LT(std::abs(work), 1e-12 * stiffness);
    const NodalField f = internal_forces(model, answer.u);
    EXPECT_LT(largest_distance(f, NodalField(f.size())), 1e-12 * law.bulk_modulus() * 0.05 * 0.05);
  } else {
    EXPECT_GT(energy, 1e-3 * stiffness);
  }
}

/// The work of a turning head equals the static body's energy. Without free nodes every level is an
/// equilibrium: work from the mean of the forces at both ends of a level then has an error of second order in
/// the level, and none where forces are linear. A straight path would give a fraction of the work.
TEST_P(RotationTest, static_work_is_the_stored_energy) {
  const auto imbalance = [&](int levels) {
    Case description = plain_case(sample_law<NeoHookean>(0.45));
    const Mesh mesh = box({0.1, 0.1, 0.1}, {2, 2, 1});
    const NodeSets sets{{"foot", nodes_where(mesh.points, [](const Vector& X) { return X[2] == 0.0; })},
                        {"head", nodes_where(mesh.points, [](const Vector& X) { return X[2] > 0.09; })}};
    description.displacements = {{"foot", {}}};
    description.rotations = {
        {.set = "head", .axis = {0, 0, 1}, .angle = 0.8, .displacement = {0.02, 0, 0.01}}};
    description.relaxation.levels = levels;
    const Scene scene = make_scene(description, mesh, sets);
    Recorder recorder;
    const Relaxation answer = relax(Model(scene, choice()), recorder);
    return recorder.rows.back().external_work / (answer.energies.strain + answer.energies.hourglass) - 1.0;
  };
  const double coarse = imbalance(20), fine = imbalance(40);
  if (method.is_linear) {
    EXPECT_NEAR(coarse, 0.0, 1e-12);
  } else {
    EXPECT_LT(std::abs(coarse), 0.02);
    EXPECT_NEAR(coarse / fine, 4.0, 0.5);
  }
}

/// In motion too, including the inertia of the driven nodes: to second order in the step.
TEST_P(RotationTest, work_in_motion_balances_energies) {
  const auto imbalance = [&](double fraction) {
    Scene scene =
        turned_block({.set = "head", .axis = {0, 0, 1}, .angle = 0.8, .displacement = {0, 0, 0.01}});
    scene.settings.quasi_static = false;
    const double dt =
        fraction * stable_step(Model(scene, choice()), NodalField(scene.mesh.points.size())).step;
    scene.settings.dynamics = {
        .duration = 0.15, .ramp_time = 0.1, .time_step = dt, .check_interval = 1, .frames = 1};
    const Model model(scene, choice());
    Recorder recorder;
    integrate(model, recorder);
    return energy_imbalance(recorder.rows);
  };
  const double coarse = imbalance(0.4), fine = imbalance(0.2);
  EXPECT_LT(coarse, 0.02);
  EXPECT_NEAR(coarse / fine, 4.0, 1.2);
}

/// Velocities of a turning set are omega x r + v at the time of the frame.
TEST(Rotation, velocities_are_those_of_a_rigid_body_at_the_frames_time) {
  const Vector center{0.05, 0.05, 0.1}, beside{0.0, 0.02, 0.01};
  const double angle = 2.5, duration = 0.2;
  Scene scene = turned_block(
      {.set = "all", .axis = oblique, .angle = angle, .center = center, .displacement = beside}, false);
  scene.settings.quasi_static = false;
  scene.settings.dynamics = {.duration = duration, .check_interval = 1, .frames = 1000};
  const Model model(scene, {"tl-full", {}});
  Recorder recorder;
  integrate(model, recorder);
  ASSERT_GT(recorder.frames.size(), 10U);
  for (const auto& frame : recorder.frames) {
    const double t = std::min(frame.time / duration, 1.0);
    const double s = t * t * t * (10 - 15 * t + 6 * t * t);         // eq. 15
    const double rate = 30 * t * t * (1 - t) * (1 - t) / duration;  // its derivative
    for (std::size_t n = 0; n < frame.u.size(); ++n) {
      Vector arm{};
      for (std::size_t i = 0; i < 3; ++i) {
        arm[i] = scene.mesh.points[n][i] + frame.u[n][i] - center[i] - s * beside[i];
      }
      const Vector spin = cross_product(oblique, arm);
      for (std::size_t i = 0; i < 3; ++i) {
        EXPECT_NEAR(frame.v[n][i], rate * (angle * spin[i] + beside[i]), 1e-13);
      }
    }
  }
}

/// The condensed answer is the linear one, at any end of the rotation; the work is half of the final forces
/// times the final displacements.
TEST(Rotation, condensed_answer_is_the_linear_one) {
  const Scene scene =
      turned_block({.set = "head", .axis = oblique, .angle = 0.7, .displacement = {0, 0, 0.01}});
  Recorder condensed, stepped;
  const Relaxation at_once = relax(Model(scene, {"linear-condensed", {}}), condensed);
  const Relaxation in_levels = relax(Model(scene, {"linear", {}}), stepped);
  ASSERT_TRUE(at_once.converged && in_levels.converged);
  // The tolerance of relaxation times the condition number of the block, as in condensed_test.cpp.
  EXPECT_LT(largest_distance(at_once.u, in_levels.u), 1e-6 * largest_imposed(scene));
  const double energy = at_once.energies.strain + at_once.energies.hourglass;
  EXPECT_NEAR(condensed.rows.back().external_work / energy, 1.0, 1e-12);
}

std::string refusal(const Case& description, const NodeSets& sets) {
  try {
    make_scene(description, box({0.1, 0.1, 0.1}, {1, 1, 1}), sets);
  } catch (const InputError& error) {
    return error.what();
  }
  return "accepted";
}

/// A whole turn ends where it began, but the body is twisted, since the path matters. Its energy equals that
/// of the turn in many equal levels.
TEST(Rotation, a_whole_turn_is_not_taken_for_none) {
  const auto energy = [](int levels) {
    Case description = plain_case(sample_law<NeoHookean>(0.45));
    const Mesh mesh = box({0.1, 0.1, 1.0}, {2, 2, 16});
    const NodeSets sets{{"foot", nodes_where(mesh.points, [](const Vector& X) { return X[2] == 0.0; })},
                        {"head", nodes_where(mesh.points, [](const Vector& X) { return X[2] > 0.99; })}};
    description.displacements = {{"foot", {}}};
    description.rotations = {{"head", {0.0, 0.0, 1.0}, 2.0 * pi, {}, {}}};
    description.relaxation.levels = levels;
    const Scene scene = make_scene(description, mesh, sets);
    Observer silent;
    const Relaxation found = relax(Model(scene, {"tl-mean-dilatation"}), silent);
    EXPECT_TRUE(found.converged);
    return found.energies.strain;
  };
  const double many = energy(60);
  EXPECT_GT(many, 0.0);
  EXPECT_NEAR(energy(0), many, 1e-6 * many);
}

/// A node may turn and be held, or turn twice, if all its paths are equal.
TEST(Rotation, two_paths_of_a_node_must_be_the_same) {
  const Mesh mesh = box({0.1, 0.1, 0.1}, {1, 1, 1});
  const auto head = nodes_where(mesh.points, [](const Vector& X) { return X[2] > 0.09; });
  const NodeSets sets{{"head", head}, {"corner", {head[0]}}};
  const ImposedRotation whole{.set = "head", .axis = {0, 0, 1}, .angle = 1.0, .center = Vector{}};
  ImposedRotation other = whole;
  other.set = "corner";
  Case description = plain_case(sample_law<NeoHookean>(0.45));
  description.rotations = {whole, other};
  EXPECT_EQ(refusal(description, sets), "accepted");
  description.rotations[1].angle = 1.0 + 2 * pi;  // ends at the same place
  description.rotations[1].center = Vector{0.02, 0.0, 0.0};
  EXPECT_NE(refusal(description, sets).find("is given two displacements in x"), std::string::npos);
  description.rotations = {whole};
  description.displacements = {{"corner", {}}};
  ASSERT_EQ(mesh.points[index(head[0])], (Vector{0.0, 0.0, 0.1}));  // on the axis
  EXPECT_EQ(refusal(description, sets), "accepted");
  description.displacements = {{"head", {}, {false, false, true}}};  // nothing moves along the axis
  EXPECT_EQ(refusal(description, sets), "accepted");
  description.displacements = {{"head", {}, {true, false, false}}};
  EXPECT_NE(refusal(description, sets).find("turning by 1 rad by set 'head'"), std::string::npos);
}

const std::string good = box_case("turn", "[1.0, 1.0, 1.0]", "[1, 1, 1]") + R"([sets]
top = { z = [1.0, 1.0] }
[[rotation]]
set = "top"
axis = [0.0, 0.0, 2.0]
angle = 90.0
)";

std::string with(const std::string& old, const std::string& replacement) {
  return replaced(good, old, replacement);
}

TEST(RotationInput, good_file_is_read_as_written) {
  const TemporaryFolder folder;
  const Scene scene = read_scene(folder.write("turn.toml", good));
  const ImposedRotation rotation = read_case_file(folder / "turn.toml").rotations.at(0);
  EXPECT_EQ(rotation.set, "top");
  EXPECT_EQ(rotation.axis, (Vector{0.0, 0.0, 1.0}));
  EXPECT_DOUBLE_EQ(rotation.angle, pi / 2);
  EXPECT_FALSE(rotation.center.has_value());
  EXPECT_EQ(rotation.displacement, Vector{});
  // A quarter turn to the left takes each corner to the next: from (0, 0) to (1, 0).
  EXPECT_EQ(scene.mesh.points[4], (Vector{0.0, 0.0, 1.0}));
  for (const auto& c : scene.constraints) {
    if (c.node != 4) continue;
    EXPECT_NEAR(final_value(scene, c), c.component == 0 ? 1.0 : 0.0, 1e-15);
  }
  EXPECT_EQ(read_scene(folder.write("letter.toml", with("[0.0, 0.0, 2.0]", "\"z\""))).case_hash,
            scene.case_hash);
}

TEST(RotationInput, hash_follows_the_rotation) {
  const TemporaryFolder folder;
  std::set<std::string> hashes{read_scene(folder.write("a.toml", good)).case_hash};
  std::size_t count = 1;
  for (const auto& text :
       {with("90.0", "450.0"), with("[0.0, 0.0, 2.0]", "[0.0, 0.1, 2.0]"), good + "center = [0, 0, 0]\n",
        good + "center = [0, 0, 1]\n", good + "displacement = [0, 0, 1]\n"}) {
    hashes.insert(read_scene(folder.write("a.toml", text)).case_hash);
    EXPECT_EQ(hashes.size(), ++count) << text;
  }
}

TEST(RotationInput, bad_ones_are_reported) {
  const TemporaryFolder folder;
  const std::vector<std::array<std::string, 3>> bad{
      {"[0.0, 0.0, 2.0]", "[0.0, 0.0, 0.0]", "rotation.axis = [0, 0, 0] must not be zero"},
      {"[0.0, 0.0, 2.0]", "[0.0, 2.0]", "rotation.axis = [0.0, 2.0] must be a list of 3"},
      {"[0.0, 0.0, 2.0]", "\"w\"", "rotation.axis = 'w' is not known"},
      {"[0.0, 0.0, 2.0]", "[0.0, 0.0, inf]", "rotation.axis = inf must be in (-inf, inf)"},
      {"angle = 90.0", "angle = inf", "rotation.angle = inf must be in (-inf, inf)"},
      {"angle = 90.0", "", "rotation.angle is missing"},
      {"angle = 90.0", "angel = 90.0", "did you mean 'angle'?"},
      {"angle = 90.0", "angle = 90.0\ncenter = [0, 0, nan]", "rotation.center"},
      {"angle = 90.0", "angle = 90.0\ndisplacement = 3", "rotation.displacement"},
      {"set = \"top\"", "set = \"lid\"", "rotation.set = 'lid' is not a node set"}};
  for (const auto& [old, replacement, words] : bad) {
    const auto file = folder.write("bad.toml", with(old, replacement));
    EXPECT_TRUE(contains(input_error([&] { read_scene(file); }), words)) << replacement;
  }
}

}  // namespace
}  // namespace sandglass::verification::rotation_test
