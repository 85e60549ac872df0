/// Checkpoints: a run resumed from any of them has the reports and results of an uninterrupted run, bit by
/// bit; incomplete files and files of other runs are rejected.

#include <gtest/gtest.h>

#include <fstream>

#include "solve/central_difference.hpp"
#include "solve/relaxation.hpp"
#include "support/kept_run.hpp"
#include "support/method_test.hpp"
#include "support/scenes.hpp"
#include "support/temporary_folder.hpp"

namespace sandglass::verification::checkpoint_test {
namespace {

/// A block on its foot, with a driven head and a load on its side.
CaseOnMesh loaded_block_case(const AnyLaw& law, bool quasi_static) {
  Case description = plain_case(law);
  const Mesh mesh = box({0.1, 0.1, 0.2}, {2, 2, 4});
  const NodeSets sets{{"foot", nodes_where(mesh.points, [](const Vector& X) { return X[2] == 0.0; })},
                      {"head", nodes_where(mesh.points, [](const Vector& X) { return X[2] > 0.19; })},
                      {"side", nodes_where(mesh.points, [](const Vector& X) { return X[0] > 0.09; })}};
  description.displacements = {{"foot", {}}, {"head", {0.02, 0.0, 0.01}}};
  description.forces.of<DeadForce>() = {{"side", {0.1, 0.2, 0.0}, {}}};
  description.relaxation.levels = 4;
  description.relaxation.tolerance = 1e-6;
  description.relaxation.max_steps = 600;  // quasi-static runs need fewer
  description.quasi_static = quasi_static;
  description.dynamics.duration = 0.1;
  description.dynamics.ramp_time = 0.05;
  description.dynamics.damping = 2.0;
  description.dynamics.frames = 6;
  description.velocities = {{.value = {0.0, 0.05, 0.0}}};
  return {description, mesh, sets};
}

Scene loaded_block(const AnyLaw& law, bool quasi_static) {
  return make_scene(loaded_block_case(law, quasi_static));
}

/// How a run ended: its bits and its outcome. A failed run is compared by its message: viscous control finds
/// no equilibrium.
struct Ending {
  std::vector<std::uint64_t> bits;
  std::string words;
  bool operator==(const Ending&) const = default;
};

Ending run(const Scene& scene, const MethodChoice& choice, KeepingRecorder& recorder,
           const Checkpoint* from = nullptr) {
  const Model model(scene, choice);
  try {
    if (scene.settings.quasi_static) {
      const Relaxation answer = relax(model, recorder, from);
      return {bits_of(recorder.run(), answer.u),
              fmt::format("{} {} {}", answer.steps, answer.residual, outcome(answer, choice.precision))};
    }
    const Motion motion = integrate(model, recorder, from);
    NodalField both = motion.u;
    both.insert(both.end(), motion.v.begin(), motion.v.end());
    return {bits_of(recorder.run(), both),
            fmt::format("{} {} {}", motion.steps, motion.time, motion.smallest_step)};
  } catch (const ComputationError& error) {
    return {bits_of(recorder.run(), {}), error.what()};
  }
}

/// Resumes from every checkpoint, read back from its file, with another number of threads.
void expect_same_from_everywhere(const Scene& scene, MethodChoice choice, std::size_t at_least) {
  const TemporaryFolder folder;
  const Identity identity{{"method", choice.method}};
  KeepingRecorder uninterrupted;
  const Ending ending = run(scene, choice, uninterrupted);
  ASSERT_GE(uninterrupted.kept().size(), at_least);
  choice.threads = 2;
  for (const auto& kept : uninterrupted.kept()) {
    write_checkpoint_file(folder / "run.h5", identity, kept);
    const RunSoFar read =
        read_checkpoint_file(folder / "run.h5", identity, scene.mesh.points.size(), scene.mesh.cells.size());
    EXPECT_EQ(read.point.arrays, kept.point.arrays);
    KeepingRecorder resumed(read);
    EXPECT_EQ(run(scene, choice, resumed, &read.point), ending)
        << "from the point after " << kept.history.size() << " rows of history";
    ASSERT_EQ(resumed.kept().size(), uninterrupted.kept().size() -
                                         static_cast<std::size_t>(&kept - uninterrupted.kept().data()) -
                                         (scene.settings.quasi_static ? 0 : 1));
    if (::testing::Test::HasFailure()) return;
  }
}

class CheckpointTest : public MethodTest {
 protected:
  void expect_same(const AnyLaw& law, bool quasi_static, std::size_t points) const {
    const Scene scene = loaded_block(law, quasi_static);
    for (const auto precision : {Precision::double_precision, Precision::single_precision}) {
      expect_same_from_everywhere(scene, choice(precision), points);
    }
  }

  /// With the first law, and with a viscoelastic one if the method supports it.
  void expect_same_with_laws(bool quasi_static, std::size_t points) const {
    expect_same(sample_law<NeoHookean>(0.45), quasi_static, points);
    if (method.knows_viscoelasticity) {
      expect_same(sample_law<Viscoelastic<NeoHookean>>(0.45), quasi_static, points);
    }
  }
};

INSTANTIATE_TEST_SUITE_P(, CheckpointTest, each_of(Methods{}), method_label);

TEST_P(CheckpointTest, motion_resumes_with_the_same_bits) {
  if (!method.is_condensed) expect_same_with_laws(false, 5);
}

/// A condensed answer is one step without a point to resume from. A control that only damps fails on the
/// first levels.
TEST_P(CheckpointTest, relaxation_resumes_with_the_same_bits) {
  if (method.is_condensed) {
    expect_same(sample_law<NeoHookean>(0.45), true, 0);
  } else {
    expect_same_with_laws(true, method.damps_only ? 1 : 5);
  }
}

/// Load levels that failed and were retried at half the distance are part of the state.
TEST(Checkpoint, resumes_after_levels_that_failed) {
  CaseOnMesh problem = loaded_block_case(sample_law<NeoHookean>(0.45), true);
  problem.description.displacements[1].value = {0.0, 0.0, -0.17};
  problem.description.forces.of<DeadForce>().clear();
  problem.description.relaxation.levels = 1;
  problem.description.relaxation.max_steps = 2000;
  const Scene scene = make_scene(problem);
  KeepingRecorder recorder;
  run(scene, {"tl-perturbation", {}}, recorder);
  ASSERT_GT(recorder.kept().back().point.arrays.at("failures").front(), 0.0) << "no level failed";
  expect_same_from_everywhere(scene, {"tl-perturbation", {}}, 3);
}

/// A load that reverses is part of the state, in each of its phases.
TEST(Checkpoint, resumes_in_every_cycle) {
  Scene scene = loaded_block(sample_law<NeoHookean>(0.45), true);
  scene.settings.relaxation.cycles = 2;
  KeepingRecorder recorder;
  run(scene, {"ul-perturbation", {}}, recorder);
  ASSERT_EQ(recorder.kept().back().point.arrays.at("leg").front(), 5.0) << "not on the last way up";
  expect_same_from_everywhere(scene, {"ul-perturbation", {}}, 10);
}

/// A checkpoint needs every entry: with any array missing, or longer by one number, it is rejected.
TEST(Checkpoint, of_another_shape_is_refused) {
  for (const bool quasi_static : {false, true}) {
    const Scene scene = loaded_block(sample_law<NeoHookean>(0.45), quasi_static);
    KeepingRecorder recorder;
    run(scene, {"ul-perturbation", {}}, recorder);
    const Checkpoint good = recorder.kept().front().point;
    ASSERT_GT(good.arrays.size(), 10U);
    for (const auto& [name, values] : good.arrays) {
      Checkpoint checkpoint = good;
      checkpoint.arrays[name].push_back(0.0);
      KeepingRecorder silent;
      EXPECT_TRUE(contains(input_error([&] {
                             run(scene, {"ul-perturbation", {}}, silent, &checkpoint);
                           }),
                           "'" + name + "' has"));
      checkpoint.arrays.erase(name);
      EXPECT_TRUE(contains(input_error([&] {
                             run(scene, {"ul-perturbation", {}}, silent, &checkpoint);
                           }),
                           "'" + name + "' is missing"));
    }
  }
}

class CheckpointFileTest : public ::testing::Test {
 protected:
  static RunSoFar sample() {
    const Frame frame{0.5,
                      {{1.0, 2.0, 3.0}, {}},
                      {{}, {4.0, 5.0, 6.0}},
                      {0.9},
                      {0.1},
                      {},
                      {1.0, 2.0, 3.0, 2.0, 4.0, 5.0, 3.0, 5.0, 6.0},
                      {{"head", {7.0, 8.0, 9.0}}, {"foot", {-7.0, -8.0, -9.0}}}};
    const double inf = std::numeric_limits<double>::infinity();
    return {.frames = {frame, frame},
            .history = {{1.0, 2.0, 3.0, 4.0, 5.0, 6.0, 7.0, 0.0, {{"foot", {}}, {"head", {0.1, 0.2, 0.3}}}},
                        {1.5, 2.5, 3.5, 4.5, 5.5, 6.5, 7.5, 0.5, {{"foot", {0.4}}, {"head", {0.5}}}}},
            .point = {{{"empty", {}}, {"step", {inf}}, {"tiny", {-0.0, 5e-324}}}}};
  }
  std::string error(const Identity& of_run) const {
    return input_error([&] { read_checkpoint_file(path, of_run, 2, 1); });
  }

  TemporaryFolder folder;
  std::filesystem::path path = folder / "run.h5";
  Identity identity{{"method", "tl-full"}, {"precision", "double"}, {"revision", "abc"}};
};

TEST_F(CheckpointFileTest, is_read_as_it_was_written) {
  write_checkpoint_file(path, identity, sample());
  EXPECT_EQ(folder.entries(), 1U);
  const RunSoFar read = read_checkpoint_file(path, identity, 2, 1);
  EXPECT_EQ(read.point.arrays, sample().point.arrays);
  EXPECT_TRUE(std::signbit(read.point.arrays.at("tiny").front()));
  EXPECT_EQ(bits_of(read, {}), bits_of(sample(), {}));
}

TEST_F(CheckpointFileTest, of_another_run_is_refused_with_the_difference) {
  write_checkpoint_file(path, identity, sample());
  const std::string text = error({{"method", "t4"}, {"precision", "double"}, {"revision", "abd"}});
  EXPECT_TRUE(contains(text, "run.h5"));
  EXPECT_TRUE(contains(text, "method: 'tl-full' in the checkpoint, 't4' in this run"));
  EXPECT_TRUE(contains(text, "revision: 'abc' in the checkpoint, 'abd' in this run"));
  EXPECT_EQ(text.find("precision"), std::string::npos);
  EXPECT_TRUE(contains(text, "delete it to start again"));
}

/// A changed byte is noticed wherever it is: in the seal, in HDF5's own structures, in numbers or after them.
TEST_F(CheckpointFileTest, with_any_byte_changed_is_refused) {
  write_checkpoint_file(path, identity, sample());
  std::ostringstream stream;
  stream << std::ifstream(path, std::ios::binary).rdbuf();
  const std::string good = stream.str();
  for (std::size_t k = 0; k < good.size(); k += k < 64 ? 1 : 37) {
    std::string bad = good;
    bad[k] = static_cast<char>(bad[k] ^ 1);
    folder.write("run.h5", bad);
    EXPECT_TRUE(contains(error(identity), "run.h5: is damaged")) << "byte " << k;
  }
  for (const std::size_t size : {std::size_t{0}, std::size_t{100}, good.size() / 2, good.size() - 1}) {
    folder.write("run.h5", good.substr(0, size));
    EXPECT_TRUE(contains(error(identity), "run.h5: is damaged")) << size << " bytes";
  }
  folder.write("run.h5", good + "x");
  EXPECT_TRUE(contains(error(identity), "run.h5: is damaged"));
  folder.write("run.h5", good);
  EXPECT_NO_THROW(read_checkpoint_file(path, identity, 2, 1));
}

TEST_F(CheckpointFileTest, of_another_mesh_is_refused) {
  write_checkpoint_file(path, identity, sample());
  EXPECT_TRUE(contains(input_error([&] { read_checkpoint_file(path, identity, 3, 1); }), "[3, 3]"));
  EXPECT_TRUE(contains(input_error([&] { read_checkpoint_file(path, identity, 2, 2); }),
                       "'/frames/0000/jacobian' must have the shape (2)"));
}

/// The next checkpoint removes temporary files of killed programs and leaves all other files.
TEST_F(CheckpointFileTest, removes_what_killed_programs_left) {
  const std::string unused = "999999999";  // above the largest process id of Linux
  const auto ours = fmt::format("run.h5.{}.part", getppid());
  for (const auto& name :
       {"run.h5." + unused + ".part", ours, std::string("run.h5.x1.part"), "other.h5." + unused + ".part"}) {
    folder.write(name, "");
  }
  write_checkpoint_file(path, identity, sample());
  EXPECT_FALSE(std::filesystem::exists(folder / ("run.h5." + unused + ".part")));
  EXPECT_TRUE(std::filesystem::exists(folder / ours));
  EXPECT_EQ(folder.entries(), 4U);
}

}  // namespace
}  // namespace sandglass::verification::checkpoint_test
