/// Ranks share the work on one body: the same bits for any number of ranks and threads, and no more traffic
/// than the method needs. Ranks are threads here (support/thread_ranks.hpp); test_ranks.py starts the program
/// with mpirun.

#include <gtest/gtest.h>

#include <numeric>

#include "assembly/chunk_sum.hpp"
#include "base/error.hpp"
#include "solve/central_difference.hpp"
#include "solve/relaxation.hpp"
#include "support/kept_run.hpp"
#include "support/method_test.hpp"
#include "support/plates.hpp"
#include "support/thread_ranks.hpp"

namespace sandglass::verification::ranks_test {
namespace {

/// A block between two plates under a pressure from one side.
CaseOnMesh block_case(const AnyLaw& law, bool quasi_static, const std::array<int, 3>& elements) {
  Case description = plain_case(law);
  description.forces.of<Pressure>() = {{.set = "side", .value = 50.0}};
  description.relaxation.max_steps = 12;
  return block_between_plates(std::move(description), quasi_static, elements);
}

Scene block(const AnyLaw& law, bool quasi_static, const std::array<int, 3>& elements) {
  return make_scene(block_case(law, quasi_static, elements));
}

/// The bits of everything that a run reports.
std::vector<std::uint64_t> told_by(const Scene& scene, const MethodChoice& choice) {
  KeepingRecorder recorder;
  const Model model(scene, choice);
  const NodalField u = scene.settings.quasi_static ? relax(model, recorder).u : integrate(model, recorder).u;
  return bits_of(recorder.run(), u);
}

void expect_same_bits(const Scene& scene, const std::string& method, int count, int threads = 1) {
  const std::vector<std::uint64_t> alone = told_by(scene, {.method = method});
  const auto together = ThreadRanks(count).run([&](std::shared_ptr<const Ranks> ranks) {
    return told_by(scene, {.method = method, .threads = threads, .ranks = std::move(ranks)});
  });
  for (const auto& bits : together) EXPECT_EQ(bits, alone) << count << " ranks";
}

class RanksTest : public MethodTest {};

INSTANTIATE_TEST_SUITE_P(, RanksTest, each_of(Methods{}), method_label);

TEST_P(RanksTest, relaxation) {
  Scene scene = block(sample_law<NeoHookean>(0.45), true, {4, 4, 18});
  if (method.is_condensed) scene.forces.clear();
  expect_same_bits(scene, GetParam(), 2);
}

TEST_P(RanksTest, motion) {
  if (!method.is_condensed) {
    expect_same_bits(block(sample_law<NeoHookean>(0.45), false, {4, 4, 18}), GetParam(), 2);
  }
}

TEST_P(RanksTest, motion_with_a_law_that_remembers) {
  if (!method.is_condensed && method.knows_viscoelasticity) {
    expect_same_bits(block(sample_law<Viscoelastic<NeoHookean>>(0.45), false, {4, 4, 18}), GetParam(), 2);
  }
}

/// Three ranks: one has neighbours on both sides.
TEST(Ranks, between_others) {
  Scene motion = block(sample_law<NeoHookean>(0.45), false, {8, 8, 192});
  motion.settings.dynamics.duration = 0.005;
  expect_same_bits(motion, "tl-perturbation", 3, 2);
  Scene rest = block(sample_law<NeoHookean>(0.45), true, {8, 8, 192});
  rest.settings.relaxation.max_steps = 5;
  expect_same_bits(rest, "tl-perturbation", 3, 2);
}

/// The mesh before refinement uses the displacements of all ranks.
TEST(Ranks, relaxation_of_a_refined_body) {
  CaseOnMesh refined = block_case(sample_law<NeoHookean>(0.45), true, {2, 2, 12});
  Case& description = refined.description;
  description.displacements[1].value = {0.1, 0.0, 0.2};
  description.relaxation.max_steps = 40;
  std::vector<int> all(refined.mesh.cells.size());
  std::iota(all.begin(), all.end(), 0);
  description.refinements = {{.around = {}, .elements = {}, .numbers = all}};
  expect_same_bits(make_scene(refined), "tl-perturbation", 2);
}

/// Sums in single precision, which depend on the order, for every division of nine pairs of chunks: ranks
/// without an interior, with one odd chunk, and with more.
TEST(Ranks, sum_over_chunks_in_one_order) {
  const Mesh mesh = box({1.0, 1.0, 16.0}, {12, 12, 256});
  const auto sum = [&](const Layout& layout) {
    Rows<float> rows(layout.rows());
    sum_over_chunks(layout, numbers_of(rows), [&](std::size_t c) {
      for (const int e : layout.elements_of(layout.chunks[c])) {
        for (const int node : mesh.cells[static_cast<std::size_t>(e)]) {
          const auto row = static_cast<std::size_t>(layout.row_of_node[static_cast<std::size_t>(node)]);
          rows[row][0] += 1.0f / static_cast<float>(1 + e % 1009);
        }
      }
    });
    return rows;
  };
  const Layout whole = make_layout(mesh, 4);
  ASSERT_EQ(whole.chunks.size(), 18U);
  const Rows<float> expected = sum(whole);
  for (int count = 1; count <= 9; ++count) {
    for (const int threads : {1, 3}) {
      const auto wrong = ThreadRanks(count).run([&](std::shared_ptr<const Ranks> ranks) {
        const Layout layout = make_layout(mesh, 4, SpareRows::where_needed, {}, {threads, std::move(ranks)});
        const Rows<float> rows = sum(layout);
        long differing = 0;
        const Blocks::Range local = layout.row_blocks.local();
        for (std::size_t row = local.first / 4; row < local.last / 4; ++row) {
          if (rows[row][0] != expected[row][0]) ++differing;
        }
        return differing;
      });
      for (const long differing : wrong) EXPECT_EQ(differing, 0) << count << " ranks";
    }
  }
}

/// In a step each neighbour gets the rows of one chunk and nothing else; only checks and reports involve all
/// ranks.
TEST(Ranks, a_step_takes_one_exchange) {
  Scene scene = block(sample_law<NeoHookean>(0.45), false, {8, 8, 192});
  scene.forces.clear();
  scene.settings.dynamics.check_interval = 1000000;
  scene.settings.dynamics.frames = 1;
  const auto traffic_of = [&](double duration) {
    scene.settings.dynamics.duration = duration;
    scene.settings.dynamics.ramp_time = 1.0;
    ThreadRanks ranks(3);
    const auto steps = ranks.run([&](std::shared_ptr<const Ranks> own) {
      Observer silent;
      return integrate(Model(scene, {.method = "tl-perturbation", .ranks = std::move(own)}), silent).steps;
    });
    return std::tuple(steps.front(), ranks.traffic(1), ranks.collectives(1));
  };
  const auto [few, less, few_collectives] = traffic_of(0.01);
  const auto [many, more, many_collectives] = traffic_of(0.03);
  ASSERT_GT(many, few + 5);
  EXPECT_EQ(more.exchanges - less.exchanges, many - few);
  EXPECT_EQ(more.messages - less.messages, 2 * (many - few));
  EXPECT_EQ(many_collectives, few_collectives);
  // The middle one of three ranks sends its chunks 2 and 3. Others share their nodes only in layers: at most
  // those of the chunk's elements plus one.
  const Layout layout = std::get<0>(Model(scene, {.method = "tl-perturbation"}).internal_force())->layout();
  const auto rows = [&](std::size_t c) { return layout.chunks[c].last_row - layout.chunks[c].first_row; };
  const auto row_bytes = static_cast<long>(sizeof(Row<double>));
  EXPECT_EQ(more.bytes - less.bytes, row_bytes * static_cast<long>(rows(2) + rows(3)) * (many - few));
}

TEST(Ranks, too_many_are_refused) {
  const Mesh mesh = box({1.0, 1.0, 1.0}, {4, 4, 18});
  const auto messages = ThreadRanks(3).run([&](std::shared_ptr<const Ranks> ranks) -> std::string {
    try {
      make_layout(mesh, 4, SpareRows::where_needed, {}, {1, std::move(ranks)});
      return "";
    } catch (const InputError& error) {
      return error.what();
    }
  });
  for (const auto& message : messages) {
    EXPECT_NE(message.find("3 are too many for a mesh of 288 elements; allowed: at most 2"),
              std::string::npos);
  }
}

/// The message of the wrong input that ends a motion.
std::string refusal_of(const Scene& scene, std::shared_ptr<const Ranks> ranks) {
  Observer silent;
  try {
    integrate(Model(scene, {.method = "tl-perturbation", .ranks = std::move(ranks)}), silent);
    return "";
  } catch (const InputError& error) {
    return error.what();
  }
}

TEST(Ranks, unsupported_features_are_refused) {
  Scene scene = block(sample_law<NeoHookean>(0.45), false, {4, 4, 18});
  scene.settings.dynamics.subcycles = 4;
  const auto messages = ThreadRanks(2).run(
      [&](std::shared_ptr<const Ranks> ranks) { return refusal_of(scene, std::move(ranks)); });
  for (const auto& message : messages) EXPECT_NE(message.find("subcycles"), std::string::npos);
}

/// Elements at one end of the block are flatter: the first or the last rank has the one that is named.
TEST(Ranks, element_that_sets_the_stable_step_is_found_on_any_rank) {
  for (const std::size_t flat : {0U, 17U}) {
    CaseOnMesh block = block_case(sample_law<NeoHookean>(0.45), false, {4, 4, 18});
    for (std::size_t n = 0; n < 25; ++n) {
      double& z = block.mesh.points[n + 25 * (flat == 0 ? 1 : flat)][2];
      z += flat == 0 ? -0.01 : 0.01;
    }
    block.description.dynamics.time_step = 1.0;
    const Scene scene = make_scene(block);
    const std::string alone = refusal_of(scene, std::make_shared<const Ranks>());
    EXPECT_NE(alone.find("set by element"), std::string::npos) << alone;
    const auto messages = ThreadRanks(2).run(
        [&](std::shared_ptr<const Ranks> ranks) { return refusal_of(scene, std::move(ranks)); });
    for (const auto& message : messages) EXPECT_EQ(message, alone);
  }
}

}  // namespace
}  // namespace sandglass::verification::ranks_test
