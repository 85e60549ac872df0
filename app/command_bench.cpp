#include <fmt/format.h>

#include <algorithm>
#include <memory>

#include "app/bench_table.hpp"
#include "app/commands.hpp"
#include "app/machine.hpp"
#include "app/progress.hpp"
#include "app/scene_report.hpp"
#include "assembly/method_entry.hpp"
#include "benchmark/bench_json.hpp"
#include "commands/bench.hpp"
#include "commands/execution_options.hpp"
#include "commands/workspace.hpp"
#include "device/opencl_processor.hpp"
#include "io/new_file.hpp"
#include "io/text_file.hpp"

namespace sandglass {

namespace {

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

/// The plan without its defaults, which depend on what is timed.
BenchPlan make_plan(const BenchOptions& options) {
  BenchPlan plan{.methods = options.methods, .threads = options.threads};
  for (const auto& precision : options.precisions) plan.precisions.push_back(parse_precision(precision));
  for (const auto& method : options.methods) method_named(method, "--methods");
  for (const int threads : options.threads) require_threads(threads);
  require_count("--repetitions", options.repetitions, 1'000'000);
  plan.settings.repetitions = options.repetitions;
  plan.processor = processor_named(options.device);
  return plan;
}

int run_bench(const BenchOptions& options) {
  const BenchPlan plan = completed(make_plan(options));
  const auto subjects = bench_subjects(options.names, options.elements, options.cubes);
  watch_for_interrupt();
  MachineSpeed machine;
  Progress progress("bench");
  const auto records = bench_all(subjects, plan, machine, understood_scene, shown_on(progress),
                                 [&](const std::vector<BenchRecord>& found) {
                                   progress.hide();
                                   fmt::print("{}\n", bench_table(found));
                                 });
  fmt::print("{}", machine_lines(plan, machine));
  fmt::print(stderr, "{}", spread_warning(records));
  if (!options.json.empty()) {
    write_text_file(options.json, to_json(build_provenance(), plan, machine, records));
  }
  return std::none_of(records.begin(), records.end(), is_wrong) ? 0 : 1;
}

int run_rest(const BenchOptions& options) {
  const BenchPlan plan = make_plan(options);
  std::vector<Scene> scenes;
  for (Case& description : cases_for_rest(options.names))
    scenes.push_back(understood_scene(std::move(description)));
  watch_for_interrupt();
  Progress progress("bench");
  const auto records = rest_all(scenes, plan, shown_on(progress),
                                [&](const Scene& scene, const std::vector<RestRecord>& found) {
                                  progress.hide();
                                  fmt::print("{}\n", rest_table(scene, found));
                                });
  if (!options.json.empty()) write_text_file(options.json, to_json(build_provenance(), records));
  require_at_rest(records);
  return 0;
}

int run_bodies(const BenchOptions& options) {
  require_count("--bodies", options.bodies, 1'000'000);
  const BenchPlan plan = make_plan(options);
  std::vector<Case> cases;
  for (const auto& name : options.names) cases.push_back(find_case(name));
  if (cases.empty()) cases.push_back(find_case("column"));
  watch_for_interrupt();
  Progress progress("bench");
  const auto records =
      bodies_all(cases, options.bodies, plan, shown_on(progress), [&](const std::vector<SideBySide>& found) {
        progress.hide();
        fmt::print("{}\n", side_by_side_table(found));
      });
  if (!options.json.empty()) write_text_file(options.json, to_json(build_provenance(), records));
  return std::all_of(records.begin(), records.end(), [](const auto& r) { return r.status == "ok"; }) ? 0 : 1;
}

}  // namespace

void add_bench_command(CLI::App& app, int& exit_code) {
  auto options = std::make_shared<BenchOptions>();
  CLI::App* command = app.add_subcommand(
      "bench",
      "time every method per element and step, and compare it with the speed of the machine.\n"
      "All variants are timed in turn in one process, after a comparison of their forces with forces in\n"
      "double precision on one thread; a variant with wrong forces is not timed, and the exit code is 1.\n"
      "sandglass-scalar also has kernels for one element at a time, and compares with them. Traffic counts\n"
      "every constant and row of a step once. A mesh above 100 % of memory stays in a cache; the roofline\n"
      "takes the bandwidth of the triad over arrays of the mesh's size. --device adds rows for another\n"
      "processor, on which the state stays between steps; shares are relative to this processor.\n"
      "With --rest: wall time from the model to static equilibrium, the median of three runs. Further runs,\n"
      "stopped earlier, find by bisection after how many evaluations of the forces all displacements differ\n"
      "from the final ones by at most 1 % and 0.1 % of the largest imposed one; their seconds are the\n"
      "corresponding share of the median");
  command->add_option("CASE", options->names,
                      "names or files of cases; default: ellipsoid-indentation unless boxes are given, with "
                      "--rest all canonical quasi-static cases");
  auto* rest = command->add_flag("--rest", options->rest, "time quasi-static cases until static equilibrium");
  auto* bodies = command->add_option(
      "--bodies", options->bodies,
      "time this many bodies of each case (default: column), side by side and one by one");
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
                   "tl-mean-dilatation, with --bodies all that run side by side")
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
