// Kernels written as source code: what is recorded computes the same as the templates, bit by bit, for every
// method, law and precision; so does the text in C. Compiled without contraction.
#include <dlfcn.h>
#include <gtest/gtest.h>

#include <cstdlib>
#include <fstream>
#include <numeric>

#include "element/methods.hpp"
#include "material/elastic_laws.hpp"
#include "support/fitting_elements.hpp"
#include "support/temporary_folder.hpp"
#include "written/kernel_text.hpp"

namespace sandglass::verification::written_test {
namespace {

/// The results of a program for these inputs.
template <class Real>
std::vector<Real> results_of(const Program& program, const std::vector<Real>& inputs) {
  std::vector<Real> values;
  for (const Step& step : program.steps) {
    const auto operand = [&](std::size_t n) {
      return step.of[n] < 0 ? Real(0) : values[static_cast<std::size_t>(step.of[n])];
    };
    if (step.operation == Operation::input) {
      values.push_back(inputs[static_cast<std::size_t>(step.of[0])]);
    } else if (step.operation == Operation::constant) {
      values.push_back(step.value.as<Real>());
    } else {
      values.push_back(result_of(step.operation, operand(0), operand(1), operand(2)));
    }
  }
  std::vector<Real> results;
  for (const int n : program.results) results.push_back(values[static_cast<std::size_t>(n)]);
  return results;
}

/// A displaced element of a method, its numbers in the order of a kernel's arrays, and its forces.
template <class Real>
struct Sample {
  std::vector<Real> inputs;
  std::vector<Real> forces;
};

template <class Real, class Aggregate>
void append(const Aggregate& aggregate, std::vector<Real>& inputs) {
  if constexpr (!std::is_empty_v<Aggregate>) {
    const auto numbers = std::bit_cast<std::array<Real, sizeof(Aggregate) / sizeof(Real)>>(aggregate);
    inputs.insert(inputs.end(), numbers.begin(), numbers.end());
  }
}

/// The same aggregate of rounded numbers.
template <class To, class From>
To rounded(const From& from) {
  To to{};
  if constexpr (!std::is_empty_v<From>) {
    const auto numbers = std::bit_cast<std::array<double, sizeof(From) / sizeof(double)>>(from);
    using Real = std::conditional_t<sizeof(To) == sizeof(From), double, float>;
    std::array<Real, numbers.size()> other;
    std::transform(numbers.begin(), numbers.end(), other.begin(),
                   [](double x) { return static_cast<Real>(x); });
    to = std::bit_cast<To>(other);
  }
  return to;
}

template <class Method, class Real>
Sample<Real> sample(RandomGeometry& random, const CalledLaw& law, bool has_fibres) {
  using Kernel = FormulationOf<Method, CalledLaw>;
  const NodalVectors<double> X = fitting_hexahedron<Kernel>(random);
  const auto exact = fitting_displacements<Kernel, NeoHookean>(random, X, 0.7, 1.4, 0.1);
  const auto constants = Kernel::precompute(X, law, {});
  const auto u = from_double<Real>(exact);
  const auto x = from_double<Real>(X);
  const auto element = rounded<typename Kernel::template Element<Real>>(constants);
  const auto axes = from_double<Real>(random.rotation());
  Sample<Real> made;
  append(u, made.inputs);
  ElementMotion<Real> motion{};
  motion.u = to_modes(u);
  if constexpr (Kernel::needs_coordinates) {
    append(x, made.inputs);
    motion.X = to_modes(x);
  }
  append(element, made.inputs);
  if (has_fibres) append(axes, made.inputs);
  typename Kernel::template History<Real> none{};
  const auto f = from_modes(Kernel::force(Kernel::deformation(motion, element), element, none,
                                          with_axes(law, has_fibres ? &axes : nullptr)));
  made.forces.assign(f.entries.begin(), f.entries.end());
  return made;
}

/// Calls use.operator()<Method>() for every method whose kernel is written.
template <class Use>
void for_each_written(const Use& use) {
  for_each_type(Methods{}, [&]<class Method>() {
    using Kernel = FormulationOf<Method, CalledLaw>;
    constexpr bool is_written = !is_condensed<Method> && !is_adaptive<Method> && !Kernel::remembers &&
                                !Kernel::averages_over_nodes && !Kernel::needs_increment;
    EXPECT_EQ(why_not_written(Method::name).empty(), is_written) << Method::name;
    if constexpr (is_written) {
      use.template operator()<Method>();
    } else {
      EXPECT_THROW(force_program(Method::name, CalledLaw(sample_law<NeoHookean>(0.45)), false), InputError);
    }
  });
}

/// Operations are the same and in the same places. Only the sign of zeros may differ, for which == holds.
TEST(Written, programs_compute_what_templates_compute) {
  RandomGeometry random(5);
  int pairs = 0;
  for_each_written([&]<class Method>() {
    for_each_type(ElasticLaws{}, [&]<class Law>() {
      const CalledLaw law(sample_law<Law>(0.45));
      const ForceProgram force = force_program(Method::name, law, !is_isotropic<Law>);
      const auto compare = [&]<class Real>(Real /*type*/) {
        for (int n = 0; n < 3; ++n) {
          const auto expected = sample<Method, Real>(random, law, !is_isotropic<Law>);
          EXPECT_EQ(results_of(force.program, expected.inputs), expected.forces)
              << Method::name << ' ' << Law::name << ' ' << sizeof(Real);
        }
      };
      compare(double{});
      compare(float{});
      ++pairs;
    });
  });
  EXPECT_GE(pairs, 13 * 8);
}

/// The kernel of a text in C, compiled. Elements are in the arrays of the text: number k of element e at
/// k * count + e.
template <class Real>
std::vector<std::vector<Real>> results_in_c(const ForceProgram& force,
                                            const std::vector<Sample<Real>>& samples) {
  const TemporaryFolder folder;
  std::ofstream(folder / "kernel.c") << kernel_text<Real>(force, dialects().front(), {"forces", {"A test."}});
  const auto library = (folder / "kernel.so").string();
  const std::string compile =
      fmt::format("{} -O2 -std=c99 -Wall -Wextra -Werror -ffp-contract=off -shared -fPIC {} -o {} -lm",
                  SANDGLASS_C_COMPILER, (folder / "kernel.c").string(), library);
  EXPECT_EQ(std::system(compile.c_str()), 0) << compile;
  void* const loaded = dlopen(library.c_str(), RTLD_NOW);
  if (loaded == nullptr) return {};
  const std::size_t count = samples.size();
  std::vector<std::vector<Real>> arrays;
  std::size_t first = 0;
  for (const KernelArray& array : force.arrays) {
    arrays.emplace_back();
    for (std::size_t k = 0; k < static_cast<std::size_t>(array.numbers); ++k, ++first) {
      for (const auto& one : samples) arrays.back().push_back(one.inputs[first]);
    }
  }
  std::vector<Real> f(24 * count);
  void* const kernel = dlsym(loaded, "forces");
  const auto n = static_cast<long>(count);
  if (arrays.size() == 2) {
    reinterpret_cast<void (*)(long, const Real*, const Real*, Real*)>(kernel)(n, arrays[0].data(),
                                                                              arrays[1].data(), f.data());
  } else {
    reinterpret_cast<void (*)(long, const Real*, const Real*, const Real*, Real*)>(kernel)(
        n, arrays[0].data(), arrays[1].data(), arrays[2].data(), f.data());
  }
  dlclose(loaded);
  std::vector<std::vector<Real>> results(count);
  for (std::size_t k = 0; k < 24; ++k) {
    for (std::size_t e = 0; e < count; ++e) results[e].push_back(f[k * count + e]);
  }
  return results;
}

template <class Method, class Law, class Real>
void compare_text() {
  RandomGeometry random(6);
  const CalledLaw law(sample_law<Law>(0.45));
  std::vector<Sample<Real>> samples;
  for (int n = 0; n < 5; ++n) samples.push_back(sample<Method, Real>(random, law, !is_isotropic<Law>));
  const auto results = results_in_c(force_program(Method::name, law, !is_isotropic<Law>), samples);
  ASSERT_EQ(results.size(), samples.size());
  for (std::size_t e = 0; e < samples.size(); ++e) EXPECT_EQ(results[e], samples[e].forces) << e;
}

/// The laws need all functions that C lacks: roots, logarithms and exponentials, selections, axes.
TEST(Written, text_in_c_computes_what_templates_compute) {
  compare_text<TlPerturbation, NeoHookean, double>();
  compare_text<TlPerturbation, NeoHookean, float>();
  compare_text<TlMeanDilatation, Ogden, double>();
  compare_text<TlMeanDilatation, Ogden, float>();
  compare_text<TlEnhanced, HolzapfelOgden, double>();
  compare_text<TlEnhanced, HolzapfelOgden, float>();
}

long count_of(const Program& program, Operation operation) {
  return std::count_if(program.steps.begin(), program.steps.end(),
                       [&](const Step& step) { return step.operation == operation; });
}

/// Equal operations share their result, in whatever order of their operands; what no result needs is left
/// out.
TEST(Tape, shares_and_drops) {
  Tape tape;
  const Recorded x = tape.input(), y = tape.input();
  [[maybe_unused]] const Recorded unused = sqrt(x / y);
  const Program program = tape.program({x * y + y * x, (y - x) * (x - y), x < y});
  EXPECT_EQ(count_of(program, Operation::multiply), 2);
  EXPECT_EQ(count_of(program, Operation::subtract), 2) << "x - y and y - x differ";
  EXPECT_EQ(count_of(program, Operation::divide) + count_of(program, Operation::sqrt), 0);
  EXPECT_EQ(results_of<double>(program, {3.0, 5.0}), (std::vector<double>{30.0, -4.0, 1.0}));
}

/// Constants are computed in the precision of the kernel, not rounded from double.
TEST(Tape, folds_constants_in_each_precision) {
  Tape tape;
  const Recorded x = tape.input();
  const Program program = tape.program({x * (Recorded(0.1) * Recorded(0.1))});
  EXPECT_EQ(count_of(program, Operation::multiply), 1);
  EXPECT_EQ(results_of<float>(program, {1.0F})[0], 0.1F * 0.1F);
  EXPECT_NE(0.1F * 0.1F, static_cast<float>(0.1 * 0.1));
  EXPECT_EQ(results_of<double>(program, {1.0})[0], 0.1 * 0.1);
}

TEST(Tape, leaves_out_what_changes_nothing) {
  Tape tape;
  const Recorded x = tape.input(), y = tape.input(), zero(0.0), one(1.0);
  const Program program =
      tape.program({x + zero, zero + x, x - zero, x * one, one * x, x / one, -(-x), x * zero, zero * x,
                    zero / x, zero - x, x + (-y), (-x) + y, x - (-y)});
  EXPECT_EQ(results_of<double>(program, {7.0, 2.0}),
            (std::vector<double>{7, 7, 7, 7, 7, 7, 7, 0, 0, 0, -7, 5, -5, 9}));
  EXPECT_EQ(count_of(program, Operation::multiply) + count_of(program, Operation::divide), 0);
  EXPECT_EQ(count_of(program, Operation::negate), 1);
}

TEST(Tape, keeps_selections) {
  Tape tape;
  const Recorded x = tape.input();
  const Program program =
      tape.program({select(x > Recorded(2.0), x, Recorded(1.0)), max(x, 4.0), min(x, 4.0), abs(x)});
  EXPECT_EQ(results_of<double>(program, {-3.0}), (std::vector<double>{1, 4, -3, 3}));
  EXPECT_EQ(results_of<double>(program, {5.0}), (std::vector<double>{5, 5, 4, 5}));
}

}  // namespace
}  // namespace sandglass::verification::written_test
