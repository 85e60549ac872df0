/// Figures that the benchmark computes from its times; methods with wrong forces are not timed.

#include <gtest/gtest.h>

#include "base/error.hpp"
#include "benchmark/bench.hpp"
#include "benchmark/force_check.hpp"
#include "benchmark/machine_speed.hpp"
#include "benchmark/measure.hpp"
#include "benchmark/rest.hpp"
#include "benchmark/stepped_model.hpp"
#include "benchmark/work.hpp"
#include "mesh/box.hpp"
#include "support/allocations.hpp"
#include "support/method_test.hpp"

namespace sandglass::verification::benchmark_test {
namespace {

TEST(Statistics, quantiles_of_known_samples) {
  const std::vector<double> samples{5.0, 1.0, 3.0, 2.0, 4.0};
  EXPECT_EQ(quantile(samples, 0.0), 1.0);
  EXPECT_EQ(quantile(samples, 0.25), 2.0);
  EXPECT_EQ(quantile(samples, 0.5), 3.0);
  EXPECT_EQ(quantile(samples, 0.875), 4.5);
  EXPECT_EQ(quantile(samples, 1.0), 5.0);
  EXPECT_EQ(quantile({1.0, 2.0}, 0.5), 1.5);
  EXPECT_EQ(quantile({7.0}, 0.99), 7.0);
  EXPECT_THROW(quantile({}, 0.5), std::invalid_argument);
  const Spread spread = spread_of(samples);
  EXPECT_EQ(spread.best, 1.0);
  EXPECT_EQ(spread.lower_quartile, 2.0);
  EXPECT_EQ(spread.median, 3.0);
  EXPECT_EQ(spread.upper_quartile, 4.0);
  EXPECT_EQ(spread.worst, 5.0);
}

TEST(Roofline, the_slower_of_arithmetic_and_traffic_binds) {
  const Ceiling machine{.gflops = 64.0, .gbs = 32.0};
  EXPECT_EQ(bound_ns({.operations = 640.0, .bytes = 32.0}, machine), 10.0);
  EXPECT_EQ(bound_ns({.operations = 640.0, .bytes = 512.0}, machine), 16.0);
  EXPECT_EQ(roofline_fraction({.operations = 640.0, .bytes = 512.0}, machine, 32.0), 0.5);
}

// Four elements in one strip: five faces of four places each, a row for each of the 20 nodes.
TEST(Traffic, of_a_strip_counted_by_hand) {
  const Layout layout = make_layout(BoxMesh{{1.0, 1.0, 4.0}, {1, 1, 4}}.build(), 1);
  ASSERT_EQ(layout.rows(), 20U);
  ASSERT_EQ(layout.packs(), 4U);
  const double places = 5 * 4 * 4, constants = 4 * 32 * 8, history = 4 * 2 * 9 * 8, rows = 20 * 4 * 8;
  EXPECT_EQ(bytes_per_element({32, 9, 1}, 8, layout, 4), (places + constants + history + 8 * rows) / 4);
  EXPECT_EQ(bytes_per_element({32, 9, 1}, 4, layout, 4), (places + (constants + history + 8 * rows) / 2) / 4);
  EXPECT_EQ(bytes_per_element({32, 0, 3}, 8, layout, 4), (places + constants + 10 * rows) / 4);
}

TEST(ForceCheck, difference_is_relative_to_the_largest_force) {
  const NodalField reference{{3.0, 0.0, 4.0}, {0.0, 1.0, 0.0}};
  EXPECT_EQ(relative_difference(reference, reference), 0.0);
  EXPECT_EQ(relative_difference({{3.0, 0.0, 4.0}, {0.0, 1.0, 2.0}}, reference), 0.4);
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_TRUE(std::isinf(relative_difference({{3.0, 0.0, 4.0}, {0.0, nan, 0.0}}, reference)));
  EXPECT_TRUE(std::isinf(relative_difference({{3.0, 0.0, 4.0}}, reference)));
  EXPECT_TRUE(std::isinf(relative_difference({{1.0, 0.0, 0.0}}, {{0.0, 0.0, 0.0}})));
}

TEST(ForceCheck, limits_grow_with_incompressibility_only_beyond_50) {
  const NeoHookean paper{.young_modulus = 3000.0, .poisson_ratio = 0.49};
  EXPECT_EQ(force_limit(Precision::double_precision, paper), 1e-12);
  EXPECT_EQ(force_limit(Precision::single_precision, paper), 2e-5);
  const NeoHookean harder{.young_modulus = 3000.0, .poisson_ratio = 0.4999};
  EXPECT_GT(force_limit(Precision::single_precision, harder), 1e-3);
}

TEST(ForceCheck, status_names_difference_and_limit) {
  EXPECT_EQ(force_status(1e-13, 1e-12), "ok");
  const std::string wrong = force_status(0.25, 1e-12);
  EXPECT_TRUE(wrong.starts_with("wrong result: ")) << wrong;
  EXPECT_NE(wrong.find("2.50e-01"), std::string::npos) << wrong;
  EXPECT_NE(force_status(std::numeric_limits<double>::infinity(), 1.0), "ok");
  EXPECT_NE(force_status(std::numeric_limits<double>::quiet_NaN(), 1.0), "ok");
}

/// Counts its calls.
class Fake final : public Steppable {
 public:
  explicit Fake(double force, std::size_t states = 1) : steps_in_state(states), force_(force) {}
  NodalField forces() override { return {{force_, 0.0, 0.0}}; }
  std::size_t states() const override { return steps_in_state.size(); }
  void restart(std::size_t state) override { state_ = state; }
  void step() override {
    ++steps;
    ++steps_in_state[state_];
  }
  void check() override {}
  void require_healthy() override { ++checks; }

  int steps = 0;
  int checks = 0;
  std::vector<int> steps_in_state;

 private:
  double force_;
  std::size_t state_ = 0;
};

TEST(Measure, wrong_forces_get_no_time) {
  const NodalField reference{{1.0, 0.0, 0.0}};
  Fake right(1.0), wrong(1.0 + 1e-9);
  const std::vector<Entry> entries{{&wrong, &reference, 1e-12}, {&right, &reference, 1e-12}};
  const auto timings =
      measure(entries, {.repetitions = 3, .batch_seconds = 1e-6}, [](double) { return true; });
  ASSERT_EQ(timings.size(), 2U);
  EXPECT_EQ(timings[0].status.rfind("wrong result: ", 0), 0U);
  EXPECT_TRUE(timings[0].seconds_per_step.empty());
  EXPECT_TRUE(timings[0].seconds_of_a_step.empty());
  EXPECT_EQ(wrong.steps, 0);
  EXPECT_EQ(timings[1].status, "ok");
  EXPECT_EQ(timings[1].seconds_per_step.size(), 3U);
  EXPECT_EQ(timings[1].seconds_of_a_step.size() % 3, 0U);
  EXPECT_GT(right.steps, 0);
  EXPECT_EQ(right.checks, 1);
}

/// A mean over states has equally many steps in each; only the first determines the length of batches.
TEST(Measure, takes_as_many_steps_in_every_state) {
  const NodalField reference{{1.0, 0.0, 0.0}};
  Fake timed(1.0, 3);
  const std::vector<Entry> entries{{&timed, &reference, 1e-12}};
  const auto timings =
      measure(entries, {.repetitions = 4, .batch_seconds = 1e-6}, [](double) { return true; });
  EXPECT_EQ(timings[0].seconds_per_step.size(), 4U);
  EXPECT_EQ(timings[0].seconds_of_a_check.size(), 4U * 3U);
  EXPECT_EQ(timings[0].seconds_of_a_step.size() % (4U * 3U), 0U);
  EXPECT_GT(timed.steps_in_state[1], 0);
  EXPECT_EQ(timed.steps_in_state[1], timed.steps_in_state[2]);
}

/// Tests of allocations would prove nothing if the counter missed some.
TEST(Allocations, are_counted_with_any_alignment) {
  constexpr std::align_val_t alignment{128};
  const long before = allocations();
  void* plain = ::operator new(1);
  void* aligned = ::operator new(1, alignment);
  EXPECT_EQ(allocations() - before, 2);
  ::operator delete(plain);
  ::operator delete(aligned, alignment);
}

TEST(Measure, ends_when_interrupted) {
  const NodalField reference{{1.0, 0.0, 0.0}};
  Fake right(1.0);
  const std::vector<Entry> entries{{&right, &reference, 1e-12}};
  EXPECT_THROW(measure(entries, {}, [](double) { return false; }), ComputationError);
}

TEST(BoxScene, has_about_the_elements_asked_for) {
  for (const int elements : {1, 2, 64, 270, 2200, 20000}) {
    const double found = static_cast<double>(box_scene(elements).mesh.cells.size());
    EXPECT_NEAR(found, elements, 0.15 * elements) << elements;
  }
  EXPECT_EQ(box_scene(64).mesh.cells.size(), 64U);
  EXPECT_EQ(shapes_in(box_scene(64).mesh), Shapes::any);
  EXPECT_EQ(shapes_in(box_scene(64, Shapes::parallelepipeds).mesh), Shapes::parallelepipeds);
}

TEST(WavyField, strains_elements_without_inverting_them) {
  const Scene scene = box_scene(64);
  const auto model = make_stepped_model(scene, {.method = "tl-perturbation"});
  model->restart(0);
  model->require_healthy();
  double largest = 0.0;
  for (const auto& u : wavy_field(scene)) {
    for (const double component : u) largest = std::max(largest, std::abs(component));
  }
  EXPECT_GT(largest, 0.02 * element_size(scene));
  EXPECT_LE(largest, 0.03 * element_size(scene));
}

class SteppedModelTest : public MethodTest {};

INSTANTIATE_TEST_SUITE_P(, SteppedModelTest, each_of(Methods{}), method_label);

// Ten thousand steps are far more than a batch has; an unstable scheme overflows within them.
TEST_P(SteppedModelTest, stays_healthy_for_good) {
  const Scene scene = box_scene(64);
  for (const Precision precision : {Precision::double_precision, Precision::single_precision}) {
    const auto model = make_stepped_model(scene, choice(precision));
    model->restart(0);
    for (int step = 0; step < 10000; ++step) model->step();
    EXPECT_NO_THROW(model->require_healthy());
  }
}

TEST_P(SteppedModelTest, steps_allocate_nothing) {
  const Scene scene = box_scene(576);
  for (const auto& variant :
       variants_of({{GetParam()}, {Precision::double_precision, Precision::single_precision}, {1, 2}, {}})) {
    const auto model = make_stepped_model(scene, variant);
    model->step();  // threads start once
    const long before = allocations();
    for (int step = 0; step < 20; ++step) model->step();
    EXPECT_EQ(allocations(), before) << name_of(variant.precision) << " " << variant.threads;
  }
}

TEST_P(SteppedModelTest, every_variant_has_the_forces_of_the_scalar_double_kernel) {
  const Scene scene = box_scene(64);
  const NodalField reference =
      make_stepped_model(scene, {.method = GetParam(), .kernel = KernelWidth::scalar})->forces();
  const BenchPlan plan{{GetParam()}, {Precision::double_precision, Precision::single_precision}, {1, 2}, {}};
  const auto variants = variants_of(plan);
  ASSERT_EQ(variants.size(), 6U);
  for (const auto& variant : variants) {
    EXPECT_LT(relative_difference(make_stepped_model(scene, variant)->forces(), reference),
              force_limit(variant.precision, scene.materials.list.front().law))
        << kernel_name(variant) << " " << name_of(variant.precision) << " " << variant.threads;
  }
}

TEST(Bench, ratios_compare_like_with_like) {
  const auto record = [](std::string method, Precision precision, KernelWidth kernel, double ns) {
    BenchRecord r{"box", 8,   27,     {.method = std::move(method), .precision = precision, .kernel = kernel},
                  "ok",  0.0, 0.0,    {},
                  {},    {},  Speed{}};
    r.speed->ns.median = ns;
    return r;
  };
  using enum Precision;
  using enum KernelWidth;
  std::vector<BenchRecord> records{record("tl-perturbation", double_precision, pack, 10.0),
                                   record("tl-perturbation", double_precision, scalar, 80.0),
                                   record("tl-full", double_precision, pack, 40.0),
                                   record("tl-full", double_precision, scalar, 160.0),
                                   record("tl-full", single_precision, pack, 20.0)};
  compare_among_each_other(records);
  EXPECT_EQ(records[0].speed->to_tl_perturbation, 1.0);
  EXPECT_EQ(records[0].speed->speedup, 8.0);
  EXPECT_EQ(records[1].speed->speedup, 1.0);
  EXPECT_EQ(records[2].speed->to_tl_perturbation, 4.0);
  EXPECT_EQ(records[2].speed->speedup, 4.0);
  EXPECT_EQ(records[3].speed->to_tl_perturbation, 2.0);
  EXPECT_FALSE(records[4].speed->to_tl_perturbation);
  EXPECT_EQ(records[4].speed->speedup, 8.0);
}

TEST(Records, are_disturbed_where_quartiles_are_far_apart) {
  BenchRecord record{"box", 8, 27, {}, "ok", 0.0, 0.0, {}, {}, {}, {}};
  EXPECT_FALSE(is_disturbed(record));  // no times
  record.speed = Speed{};
  record.speed->ns.lower_quartile = 10.0;
  record.speed->ns.upper_quartile = 12.9;
  EXPECT_FALSE(is_disturbed(record));
  record.speed->ns.upper_quartile = 13.1;
  EXPECT_TRUE(is_disturbed(record));
}

/// A made-up error that falls as 1 / (1 + n) is below 1 / k from n = k on; bisection finds each limit
/// exactly, with as many evaluations as the last one's number has binary digits.
TEST(Rest, bisection_finds_the_first_below) {
  int looks = 0;
  const auto error = [&](long n) {
    ++looks;
    EXPECT_GE(n, 0);
    EXPECT_LT(n, 1000);  // the error is known to be below at the last one
    return 1.0 / static_cast<double>(1 + n);
  };
  for (const long k : {1L, 2L, 99L, 100L, 511L, 512L, 999L, 1000L}) {
    looks = 0;
    EXPECT_EQ(first_below(1000, 1.0 / static_cast<double>(k), error), k);
    EXPECT_LE(looks, 10);
  }
  EXPECT_EQ(first_below(1000, 1.5, error), 0);
  EXPECT_EQ(first_below(0, 0.5, error), 0);
}

/// An error that rises again: bisection finds one of the crossings.
TEST(Rest, bisection_finds_a_crossing_where_there_are_more) {
  const auto error = [](long n) { return n < 10 || (n >= 40 && n < 60) ? 1.0 : 0.0; };
  const long found = first_below(100, 0.5, error);
  EXPECT_TRUE(found == 10 || found == 60) << found;
}

TEST(Rest, seconds_are_in_order_and_a_failure_is_a_status) {
  Scene scene = box_scene(64);
  const RestRecord record = time_to_rest(scene, {"tl-perturbation", {}}, [](double) { return true; });
  ASSERT_EQ(record.status, "ok");
  ASSERT_TRUE(record.times);
  EXPECT_GT(record.times->to_1_percent, 0.0);
  EXPECT_LE(record.times->to_1_percent, record.times->to_0_1_percent);
  EXPECT_LT(record.times->to_0_1_percent, record.times->to_rest);
  scene.settings.relaxation.max_steps = 5;
  const RestRecord failed = time_to_rest(scene, {"tl-perturbation", {}}, [](double) { return true; });
  EXPECT_EQ(failed.status.rfind("failed: no equilibrium after ", 0), 0U) << failed.status;
  EXPECT_FALSE(failed.times);
  EXPECT_THROW(time_to_rest(scene, {"tl-perturbation", {}}, [](double) { return false; }), ComputationError);
}

TEST(MachineSpeed, is_a_positive_number) {
  MachineSpeed machine;
  const Ceiling ceiling = machine.ceiling(Precision::double_precision, 1, 1 << 16);
  EXPECT_GT(ceiling.gflops, 0.0);
  EXPECT_GT(ceiling.gbs, 0.0);
  machine.measure_again();
  EXPECT_GE(machine.ceiling(Precision::double_precision, 1, 1 << 16).gflops, ceiling.gflops);
}

}  // namespace
}  // namespace sandglass::verification::benchmark_test
