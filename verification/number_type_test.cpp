// The kernels with number types other than double: packs compute the same as doubles, and counting numbers
// count correctly.
#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <random>

#include "counting/counted.hpp"
#include "counting/operation_count.hpp"
#include "counting/paper_hourglass_force.hpp"
#include "element/methods.hpp"
#include "math/pack.hpp"
#include "support/fitting_elements.hpp"
#include "support/sample_law.hpp"
#include "support/typed_lists.hpp"

namespace sandglass::verification::number_type_test {
namespace {

constexpr double eps = 0x1p-52;

/// x^(-1/3) from long double.
template <class T>
double exact_root(T x) {
  return static_cast<double>(1.0L / std::cbrt(static_cast<long double>(x)));
}

/// The root of packs uses no library function. Its last step is of fourth order with an error far below
/// rounding; what remains is the rounding of r, of y r and of the sum: two units in the last place.
template <class T>
void check_root_of_packs() {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> exponent(-9.0, 9.0);
  for (int sample = 0; sample < 100000; ++sample) {
    const T x = static_cast<T>(std::exp2(exponent(random)));
    const double root = static_cast<double>(inverse_cube_root(Pack<T>(x)).lanes[0]);
    const double unit = static_cast<double>(std::numeric_limits<T>::epsilon());
    ASSERT_NEAR(root / exact_root(x), 1.0, 2.0 * unit) << x;
  }
}

TEST(Pack, root_is_within_two_units_in_the_last_place) {
  check_root_of_packs<double>();
  check_root_of_packs<float>();
}

TEST(Pack, every_lane_is_computed_by_itself) {
  Pack<double> x(1.0);
  for (int lane = 0; lane < Pack<double>::width; ++lane) x.lanes[lane] = 1.0 + lane;
  const Pack<double> y = select(x < Pack<double>(2.5), x * x - x, -x / Pack<double>(2.0));
  const Pack<double> root = inverse_cube_root(x);
  for (int lane = 0; lane < Pack<double>::width; ++lane) {
    const double one = 1.0 + lane;
    EXPECT_EQ(y.lanes[lane], one < 2.5 ? one * one - one : -one / 2.0);
    EXPECT_NEAR(root.lanes[lane], 1.0 / std::cbrt(one), 2.0 * eps);
  }
}

/// An aggregate of numbers as a row of them, and back.
template <class Number, class Aggregate>
auto as_numbers(const Aggregate& aggregate) {
  return std::bit_cast<std::array<Number, sizeof(Aggregate) / sizeof(Number)>>(aggregate);
}

template <class Pair>
class PackedKernel : public testing::Test {
 protected:
  using Kernel = typename Pair::Kernel;
  using P = Pack<double>;
  template <class T>
  using Constants = typename Kernel::template Element<T>;
  template <class T>
  using History = typename Kernel::template History<T>;

  /// A displaced element, with memory if the method has one.
  struct Sample {
    ElementMotion<double> motion;
    Constants<double> constants;
    History<double> history;
  };

  /// The lanes of packs from as many samples.
  template <class Packed, class Member>
  static Packed pack(const std::array<Sample, P::width>& samples, Member Sample::*member) {
    std::array<P, sizeof(Packed) / sizeof(P)> numbers{};
    for (int lane = 0; lane < P::width; ++lane) {
      const auto row = as_numbers<double>(samples[static_cast<std::size_t>(lane)].*member);
      for (std::size_t k = 0; k < row.size(); ++k) numbers[k].lanes[lane] = row[k];
    }
    return std::bit_cast<Packed>(numbers);
  }

  Sample sample(const typename Pair::Law& law) {
    const NodalVectors<double> X = fitting_hexahedron<Kernel>(random);
    const auto u = fitting_displacements<Kernel, typename Pair::Law>(random, X, 0.7, 1.4, 0.1);
    const double size = std::cbrt(mean_gradient(X).volume);
    Sample s{{to_modes(u), {}, to_modes(X)}, Kernel::precompute(X, law, {}), {}};
    for (auto& entry : s.motion.increment.entries) entry = random.uniform(-0.01, 0.01) * size;
    for (auto& entry : s.motion.dilatation) entry = random.uniform(-0.1, 0.1);
    fill(s.history.hourglass, size * size);
    fill(s.history.law, sample_young_modulus);
    return s;
  }

  /// Random numbers of a given size for every part of the history.
  template <class Part>
  void fill(Part& part, double size) {
    if constexpr (!std::is_empty_v<Part>) {
      auto numbers = as_numbers<double>(part);
      for (double& number : numbers) number = random.uniform(-1, 1) * size;
      part = std::bit_cast<Part>(numbers);
    }
  }

  void compare_packs_with_doubles() {
    const auto elastic_or_not = sample_law<typename Pair::Law>(0.45);
    const auto law = at_step(elastic_or_not, 0.1);
    std::array<Sample, P::width> samples;
    for (auto& s : samples) s = sample(elastic_or_not);
    const auto motion = pack<ElementMotion<P>>(samples, &Sample::motion);
    Constants<P> constants;
    if constexpr (sizeof(constants) >= sizeof(P)) constants = pack<Constants<P>>(samples, &Sample::constants);
    History<P> history;
    if constexpr (Kernel::remembers) history = pack<History<P>>(samples, &Sample::history);
    const auto packed = Kernel::force(Kernel::deformation(motion, constants), constants, history, law);
    for (int lane = 0; lane < P::width; ++lane) {
      auto& s = samples[static_cast<std::size_t>(lane)];
      const auto plain =
          Kernel::force(Kernel::deformation(s.motion, s.constants), s.constants, s.history, law);
      const double size = Kernel::stiffness_bound(s.motion, s.constants, s.history, law) *
                          std::sqrt(double_dot(s.motion.u, s.motion.u));
      for (std::size_t k = 0; k < 21; ++k) {
        const double difference = std::abs(packed.entries[k].lanes[lane] - plain.entries[k]);
        EXPECT_LE(difference, strict ? 0.0 : 64 * eps * size) << "lane " << lane;
      }
    }
  }

 private:
#ifdef SANDGLASS_STRICT_FP
  static constexpr bool strict = true;
#else
  static constexpr bool strict = false;
#endif
  RandomGeometry random{11};
};
TYPED_TEST_SUITE(PackedKernel, MethodWithLawTypes, EntryName);

/// Every method's force on a pack of different elements against the same kernel on doubles. With strict
/// floating point these are the same operations, hence the same bits. Otherwise the compiler contracts them
/// differently: each is some hundred operations deep on terms as large as stiffness times displacement.
TYPED_TEST(PackedKernel, computes_what_doubles_compute) {
  this->compare_packs_with_doubles();
}

/// Table I of the paper: eq. 14 as written is 180 + 12 + 168 operations.
TEST(Counted, eq_14_as_the_paper_writes_it_takes_360_operations) {
  const Operations tally = count_paper_hourglass_force();
  EXPECT_EQ(tally.mul, 4 * 3 * 8 + 12 + 8 * 3 * 4);
  EXPECT_EQ(tally.add, 4 * 3 * 7 + 8 * 3 * 3);
  EXPECT_EQ(tally.total(), 360);
}

/// In modal form the control shares the butterflies with the element. By itself it takes 12 x 6 operations
/// for q, 12 for k q, 9 x 7 for c^T Q, 9 to subtract it from the stress and 12 to add Q to the modes.
TEST(Counted, the_hourglass_control_in_modes_stays_below_246_operations) {
  const auto count = count_operations<OnePoint, PerturbationHourglassControl>(sample_law<NeoHookean>(0.49));
  EXPECT_EQ(count.hourglass.total(), 12 * 6 + 12 + 9 * 7 + 9 + 12);
  EXPECT_LE(count.hourglass.total(), 246);
  const Operations sum = count.gradient + count.law + count.force + count.hourglass;
  EXPECT_EQ(sum.total(), count.total.total());
}

TEST(Counted, distinguishes_the_kinds_and_skips_constants) {
  Operations tally;
  const Counted x(2.0, tally);
  const Counted y = sqrt(x * x + Counted(1.0) * Counted(3.0)) / -x;
  EXPECT_EQ(y.value(), std::sqrt(7.0) / -2.0);
  EXPECT_EQ(tally.mul, 1);
  EXPECT_EQ(tally.add, 1);
  EXPECT_EQ(tally.div, 1);
  EXPECT_EQ(tally.special, 1);
  EXPECT_EQ(tally.total(), 4) << "every kind counts";
}

}  // namespace
}  // namespace sandglass::verification::number_type_test
