#include <fmt/format.h>

#include <algorithm>
#include <memory>

#include "app/bench_table.hpp"
#include "app/commands.hpp"
#include "app/execution_options.hpp"
#include "app/machine.hpp"
#include "app/progress.hpp"
#include "app/scene_report.hpp"
#include "app/workspace.hpp"
#include "assembly/method_entry.hpp"
#include "base/error.hpp"
#include "base/names.hpp"
#include "benchmark/bench.hpp"
#include "benchmark/bench_json.hpp"
#include "benchmark/rest.hpp"
#include "benchmark/side_by_side.hpp"
#include "benchmark/stepped_model.hpp"
#include "comparison/comparison.hpp"
#include "device/opencl_processor.hpp"
#include "io/case_file.hpp"
#include "io/new_file.hpp"
#include "io/text_file.hpp"

namespace sandglass {

namespace {

constexpr int most_elements = 100'000'000;

struct BenchOptions {
  std::vector<std::string> names;
  std::vector<int> elements;
  std::vector<int> cubes;
  std::vector<std::string> methods;
  std::vector<std::string> precisions{"double", "float"};
  std::vector<int> threads;
  int repetitions = MeasureSettings{}.repetitions;
  bool rest = false;
  int bodies = 0;
  std::string json;
  std::string device = "cpu";
};

template <class Value>
std::vector<Value> without_repeats(const std::vector<Value>& values) {
  std::vector<Value> kept;
  for (const auto& value : values) {
    if (std::find(kept.begin(), kept.end(), value) == kept.end()) kept.push_back(value);
  }
  return kept;
}

BenchPlan make_plan(const BenchOptions& options) {
  BenchPlan plan;
  for (const auto& name : options.methods) method_named(name, "--methods");
  plan.methods = options.methods.empty() ? method_names() : without_repeats(options.methods);
  for (const auto& precision : options.precisions) plan.precisions.push_back(parse_precision(precision));
  plan.precisions = without_repeats(plan.precisions);
  for (const int threads : options.threads) require_threads(threads);
  plan.threads = without_repeats(options.threads);
  if (plan.threads.empty()) plan.threads = available_processors() > 1 ? std::vector{1, 2} : std::vector{1};
  require_count("--repetitions", options.repetitions, 1'000'000);
  plan.settings.repetitions = options.repetitions;
  plan.processor = processor_named(options.device);
  return plan;
}

/// The source of a scene. Scenes are made one after another, because large ones fill the memory.
struct Subject {
  std::optional<Case> description;  ///< none for a box
  int elements = 0;
  Shapes shapes = Shapes::any;  ///< of a box
};

std::vector<Subject> find_subjects(const BenchOptions& options) {
  std::vector<Subject> subjects;
  for (const auto& name : options.names) subjects.push_back({find_case(name)});
  for (const int elements : options.elements) {
    require_count("--elements", elements, most_elements);
    subjects.push_back({{}, elements});
  }
  for (const int cubes : options.cubes) {
    require_count("--cubes", cubes, most_elements);
    subjects.push_back({{}, cubes, Shapes::parallelepipeds});
  }
  if (subjects.empty()) subjects.push_back({find_case("ellipsoid-indentation")});
  return subjects;
}

int run_bench(const BenchOptions& options) {
  const BenchPlan plan = make_plan(options);
  const auto subjects = find_subjects(options);
  watch_for_interrupt();
  MachineSpeed machine;
  std::vector<BenchRecord> records;
  for (std::size_t n = 0; n < subjects.size(); ++n) {
    const Subject& subject = subjects[n];
    const Scene scene = subject.description ? understood_scene(*subject.description)
                                            : box_scene(subject.elements, subject.shapes);
    std::vector<BenchRecord> found;
    {
      Progress progress("bench");
      const auto proceed = [&](double share) {
        progress.show((static_cast<double>(n) + share) / static_cast<double>(subjects.size()),
                      fmt::format("{}, {} elements", scene.settings.name, scene.mesh.cells.size()));
        return !interrupted();
      };
      OwnMotions motions;  // boxes have none
      if (subject.description) motions = follow_own_motions(scene, plan.methods, proceed);
      found = bench(scene, motions, plan, machine, proceed);
    }
    fmt::print("{}\n", bench_table(found));
    records.insert(records.end(), found.begin(), found.end());
  }
  fmt::print("{}", machine_lines(plan, machine));
  fmt::print(stderr, "{}", spread_warning(records));
  if (!options.json.empty()) {
    write_text_file(options.json, to_json(build_provenance(), plan, machine, records));
  }
  return std::none_of(records.begin(), records.end(), is_wrong) ? 0 : 1;
}

/// Packs only, by default on one thread.
std::vector<MethodChoice> packed_variants(BenchOptions options) {
  if (options.threads.empty()) options.threads = {1};
  auto variants = variants_of(make_plan(options));
  std::erase_if(variants, [](const MethodChoice& choice) { return choice.kernel == KernelWidth::scalar; });
  return variants;
}

/// The variants that --rest times: packs only; by default one thread, one method with one point and one with
/// eight.
std::vector<MethodChoice> rest_variants(BenchOptions options) {
  if (options.methods.empty()) options.methods = {"tl-perturbation", std::string(golden_method)};
  return packed_variants(std::move(options));
}

int run_rest(const BenchOptions& options) {
  const auto variants = rest_variants(options);
  auto scenes = read_scenes(
      options.names, [](const Case& description) { return description.quasi_static; },
      "static equilibrium to time");
  if (options.names.empty()) {  // small cases with published values test accuracy, not time
    std::erase_if(scenes,
                  [](const Scene& scene) { return !read_comparison(scene.settings).published.empty(); });
  }
  watch_for_interrupt();
  std::vector<RestRecord> records;
  for (const auto& scene : scenes) {
    std::vector<RestRecord> found;
    {
      Progress progress("bench");
      for (const auto& choice : variants) {
        found.push_back(time_to_rest(scene, choice, [&](double share) {
          const auto done = static_cast<double>(records.size() + found.size()) + share;
          progress.show(done / static_cast<double>(scenes.size() * variants.size()),
                        fmt::format("{}, {}", scene.settings.name, choice.method));
          return !interrupted();
        }));
      }
    }
    fmt::print("{}\n", rest_table(scene, found));
    records.insert(records.end(), found.begin(), found.end());
  }
  if (!options.json.empty()) write_text_file(options.json, to_json(build_provenance(), records));
  const auto failed = std::count_if(records.begin(), records.end(), [](const auto& r) { return !r.times; });
  if (failed > 0)
    throw ComputationError(
        fmt::format("bench: {} of {} found no static equilibrium", failed, records.size()));
  return 0;
}

/// The default methods of --bodies: all that compute bodies side by side.
std::vector<MethodChoice> variants_of_bodies(BenchOptions options) {
  if (options.methods.empty()) {
    for (const MethodEntry& method : methods()) {
      if (method.packed_double.assemble_batch != nullptr) options.methods.emplace_back(method.name);
    }
  }
  return packed_variants(std::move(options));
}

int run_bodies(const BenchOptions& options) {
  require_count("--bodies", options.bodies, 1'000'000);
  const auto variants = variants_of_bodies(options);
  watch_for_interrupt();
  std::vector<SideBySide> records;
  const std::vector<std::string> names =
      options.names.empty() ? std::vector<std::string>{"column"} : options.names;
  for (const auto& name : names) {
    const Case description = find_case(name);
    std::vector<SideBySide> found;
    {
      Progress progress("bench");
      for (const auto& choice : variants) {
        const auto proceed = [&](double share) {
          progress.show((static_cast<double>(found.size()) + share) / static_cast<double>(variants.size()),
                        fmt::format("{}, {}", description.name, choice.method));
          return !interrupted();
        };
        found.push_back(time_side_by_side(description, choice, static_cast<std::size_t>(options.bodies),
                                          options.repetitions, proceed));
      }
    }
    fmt::print("{}\n", side_by_side_table(found));
    records.insert(records.end(), found.begin(), found.end());
  }
  if (!options.json.empty()) write_text_file(options.json, to_json(build_provenance(), records));
  return std::all_of(records.begin(), records.end(), [](const auto& r) { return r.status == "ok"; }) ? 0 : 1;
}

}  // namespace

void add_bench_command(CLI::App& app, int& exit_code) {
  auto options = std::make_shared<BenchOptions>();
  CLI::App* command = app.add_subcommand(
      "bench",
      "time every method per element and step, and compare it with the speed of the machine.\n"
      "All variants are timed in turn in one process, after their forces were compared with those in double\n"
      "precision on one thread; one that is wrong gets no time, and the exit code is 1. sandglass-scalar "
      "has\n"
      "kernels that compute one element at a time too, and compares with those. Traffic counts every\n"
      "constant and row of a step once. Above 100 % of memory a mesh stays in a cache; the roofline holds "
      "it\n"
      "against the triad over arrays of its own size. --device adds rows for another processor, copies to "
      "and\n"
      "from it included; their shares are still of this one.\n"
      "With --rest: wall time from the model to static equilibrium, the median of three runs. Further runs,\n"
      "stopped earlier, find by bisection after how many force evaluations all displacements differ from "
      "the\n"
      "final ones by at most 1 % and 0.1 % of the largest imposed one; their seconds are that share of the\n"
      "median");
  command->add_option("CASE", options->names,
                      "names or files of cases; default: ellipsoid-indentation unless boxes are given, with "
                      "--rest all canonical quasi-static cases");
  auto* rest = command->add_flag("--rest", options->rest, "time quasi-static cases until static equilibrium");
  auto* bodies =
      command->add_option("--bodies", options->bodies,
                          "time this many bodies of each case (default: column) side by side and one by one");
  bodies->excludes(rest);
  command->add_option("-e,--elements", options->elements, "also time boxes of about this many elements")
      ->excludes(rest)
      ->excludes(bodies);
  command
      ->add_option("-c,--cubes", options->cubes,
                   "also time boxes of about this many cubes, which some methods compute in less time")
      ->excludes(rest)
      ->excludes(bodies);
  command->add_option(
      "-t,--threads", options->threads,
      "numbers of threads; default: 1 and 2 if the machine has two, with --rest or --bodies 1");
  command
      ->add_option("-m,--methods", options->methods,
                   "methods, see `sandglass methods`; default: all, with --rest tl-perturbation and "
                   "tl-mean-dilatation, with --bodies those that run side by side")
      ->type_name("METHOD");
  command->add_option("-p,--precision", options->precisions, "double, float or both")->capture_default_str();
  command
      ->add_option("-r,--repetitions", options->repetitions,
                   "batches of about 0.5 ms for each variant, timed twice")
      ->excludes(rest)
      ->capture_default_str();
  add_device_option(*command, options->device)->excludes(rest)->excludes(bodies);
  command->add_option("--json", options->json, "write every figure to this file");
  command->callback([options, bodies, &exit_code] {
    if (!options->json.empty()) require_place(options->json, {options->names.begin(), options->names.end()});
    exit_code = options->rest         ? run_rest(*options)
                : bodies->count() > 0 ? run_bodies(*options)
                                      : run_bench(*options);
  });
}

}  // namespace sandglass
