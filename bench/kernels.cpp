/// Times single kernels, for work on a kernel: every method, on every number type that runs.
///   element/METHOD/NUMBER            the arithmetic of elements in a strip: no gather, no scatter
///   forces/METHOD/NUMBER/ELEMENTS    internal forces of a box
///   step/METHOD/NUMBER/ELEMENTS      the whole explicit step
/// Times are per call; those per element are in the counter `per_element`. Options: --help. To compare
/// methods, use `sandglass bench`, which times all in turn.

#include <benchmark/benchmark.h>
#include <fmt/format.h>

#include "assembly/internal_force.hpp"
#include "benchmark/force_check.hpp"
#include "benchmark/stepped_model.hpp"
#include "element/methods.hpp"
#include "math/pack.hpp"

namespace sandglass {
namespace {

using benchmark::State;

/// A counter that shows the time for one of `elements`.
void count_elements(State& state, std::size_t elements) {
  state.counters["per_element"] =
      benchmark::Counter(static_cast<double>(elements),
                         benchmark::Counter::kIsIterationInvariantRate | benchmark::Counter::kInvert);
}

constexpr NeoHookean law{.young_modulus = 3000.0, .poisson_ratio = 0.49};

/// The same number in every entry of an aggregate of numbers, changed a little from entry to entry.
template <class Aggregate, class Number>
Aggregate filled(double value) {
  std::array<Number, sizeof(Aggregate) / sizeof(Number)> entries;
  for (std::size_t n = 0; n < entries.size(); ++n) {
    const double entry = value * (1.0 + 1e-3 * static_cast<double>(n));
    entries[n] = Number(static_cast<typename Lanes<Number>::Scalar>(entry));
  }
  return std::bit_cast<Aggregate>(entries);
}

/// A strip of blocks whose constants stay in the first cache.
template <class Kernel, class Number>
void element(State& state) {
  using Constants = typename Kernel::template Element<Number>;
  using History = typename Kernel::template History<Number>;
  using Scalar = typename Lanes<Number>::Scalar;
  constexpr std::size_t blocks = 8;
  const auto plain = std::bit_cast<std::array<double, sizeof(Constants) / sizeof(Number)>>(
      Kernel::precompute(0.5 * corner_signs, law, {}));
  std::array<Number, plain.size()> numbers;
  for (std::size_t n = 0; n < plain.size(); ++n) numbers[n] = Number(static_cast<Scalar>(plain[n]));
  std::vector<Constants> constants(blocks, std::bit_cast<Constants>(numbers));
  std::vector<History> histories(blocks);
  if constexpr (Kernel::remembers) {
    for (auto& history : histories) history = filled<History, Number>(0.0);
  }
  ElementMotion<Number> motion;
  motion.u = filled<Modes<Number>, Number>(1e-3);
  motion.inverse_step = Number(Scalar(1e3));
  if constexpr (Kernel::needs_increment) motion.increment = filled<Modes<Number>, Number>(1e-6);
  if constexpr (Kernel::needs_coordinates) {
    NodalVectors<Number> X;  // the cube of edge 1 that the constants belong to
    for (std::size_t n = 0; n < X.entries.size(); ++n) {
      X.entries[n] = Number(static_cast<Scalar>(0.5 * corner_signs.entries[n]));
    }
    motion.X = to_modes(X);
  }
  if constexpr (Kernel::averages_over_nodes) {
    motion.dilatation = filled<decltype(motion.dilatation), Number>(1e-3);
  }
  for ([[maybe_unused]] auto _ : state) {
    for (std::size_t block = 0; block < blocks; ++block) {
      benchmark::DoNotOptimize(motion);
      if constexpr (Kernel::averages_over_nodes) {
        const auto volumes = Kernel::nodal_volumes(motion, constants[block]);
        benchmark::DoNotOptimize(volumes);
      }
      const auto f = Kernel::force(Kernel::deformation(motion, constants[block]), constants[block],
                                   histories[block], law);
      benchmark::DoNotOptimize(f);
    }
  }
  count_elements(state, blocks * static_cast<std::size_t>(Lanes<Number>::width));
}

NodalField forces_of(const Scene& scene, const MethodChoice& choice) {
  const Model model(scene, choice);
  return std::visit([&](const auto& elements) { return forces_on_the_way(*elements, wavy_field(scene)); },
                    model.internal_force());
}

/// Whether a kernel's forces are those of the method's scalar double kernel: a wrong result is not timed.
bool right(State& state, const Scene& scene, const MethodChoice& choice) {
  const NodalField reference = forces_of(scene, {.method = choice.method, .kernel = KernelWidth::scalar});
  const std::string status = force_status(relative_difference(forces_of(scene, choice), reference),
                                          force_limit(choice.precision, scene.materials.list.front().law));
  if (status != "ok") state.SkipWithError(status.c_str());
  return status == "ok";
}

/// Internal forces of a wavy box.
void forces(State& state, const MethodChoice& choice, int elements) {
  const Scene scene = box_scene(elements);
  if (!right(state, scene, choice)) return;
  const Model model(scene, choice);
  std::visit(
      [&]<class Real>(const std::unique_ptr<InternalForce<Real>>& internal) {
        auto body = state_at(*internal, wavy_field(scene));
        Rows<Real> force(body.u.size());
        internal->evaluate(body, force);
        std::fill(body.increment.begin(), body.increment.end(), Row<Real>{});
        for ([[maybe_unused]] auto _ : state) {
          internal->evaluate(body, force);
          benchmark::ClobberMemory();
        }
      },
      model.internal_force());
  count_elements(state, scene.mesh.cells.size());
}

void step(State& state, const MethodChoice& choice, int elements) {
  const Scene scene = box_scene(elements);
  if (!right(state, scene, choice)) return;
  const auto model = make_stepped_model(scene, choice);
  model->restart();
  for ([[maybe_unused]] auto _ : state) model->step();
  model->require_healthy();
  count_elements(state, scene.mesh.cells.size());
}

void register_all() {
  for_each_type(Methods{}, []<class Method>() {
    using Kernel = FormulationOf<Method, NeoHookean>;
    const auto name = [](std::string_view what, std::string_view number) {
      return fmt::format("{}/{}/{}", what, Method::name, number);
    };
    benchmark::RegisterBenchmark(name("element", "double").c_str(), element<Kernel, double>);
    benchmark::RegisterBenchmark(name("element", "pack-double").c_str(), element<Kernel, Pack<double>>);
    benchmark::RegisterBenchmark(name("element", "pack-float").c_str(), element<Kernel, Pack<float>>);
    const auto with_mesh = [&](std::string_view number, Precision precision, KernelWidth kernel) {
      const MethodChoice choice{
          .method = std::string(Method::name), .precision = precision, .kernel = kernel};
      for (const int elements : {270, 2200, 20000}) {
        const auto sized = [&](std::string_view what) {
          return fmt::format("{}/{}", name(what, number), elements);
        };
        benchmark::RegisterBenchmark(sized("forces").c_str(), forces, choice, elements);
        benchmark::RegisterBenchmark(sized("step").c_str(), step, choice, elements);
      }
    };
    with_mesh("double", Precision::double_precision, KernelWidth::scalar);
    with_mesh("pack-double", Precision::double_precision, KernelWidth::pack);
    with_mesh("pack-float", Precision::single_precision, KernelWidth::pack);
  });
}

}  // namespace
}  // namespace sandglass

int main(int argc, char** argv) {
  sandglass::register_all();
  benchmark::Initialize(&argc, argv);
  if (benchmark::ReportUnrecognizedArguments(argc, argv)) return 2;
  benchmark::RunSpecifiedBenchmarks();
  benchmark::Shutdown();
  return 0;
}
