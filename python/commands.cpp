#include "commands.hpp"

#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "app/machine.hpp"
#include "arguments.hpp"
#include "assembly/method_entry.hpp"
#include "benchmark/bench_json.hpp"
#include "choice/case_writer.hpp"
#include "choice/choose_json.hpp"
#include "commands/bench.hpp"
#include "commands/execution_options.hpp"
#include "commands/failure_maps.hpp"
#include "commands/flops.hpp"
#include "commands/foreign_files.hpp"
#include "commands/kernels.hpp"
#include "commands/mesh_output.hpp"
#include "commands/score.hpp"
#include "commands/verify.hpp"
#include "commands/workspace.hpp"
#include "comparison/mesh_quality.hpp"
#include "comparison/verdict_json.hpp"
#include "derivatives.hpp"
#include "device/opencl_processor.hpp"
#include "io/case_file.hpp"
#include "io/new_file.hpp"
#include "io/text_file.hpp"
#include "problem/held.hpp"
#include "stability/cell_files.hpp"
#include "watch.hpp"

namespace py = pybind11;

namespace sandglass {
namespace {

using Json = nlohmann::ordered_json;

ProgressOf progress_of(Watch& watch) {
  return [&watch](double share, const std::string& /*remark*/) { return watch.proceed(share); };
}

/// The scene of a case. Throws InputError for a body at rest that is not held.
Scene held_scene(const Case& description) {
  Scene scene = make_scene(with_mesh(description));
  if (scene.settings.quasi_static) require_held(scene);
  return scene;
}

void require_worker_count(const Arguments& given) {
  const int threads = given.integer("threads");
  if (threads < 0 || threads > 1024)
    throw InputError(fmt::format("threads = {} must be in [0, 1024]; 0 is one per processor", threads));
}

int thread_count(const Arguments& given) {
  require_count("threads", given.integer("threads"), 1024);
  return given.integer("threads");
}

std::string cases(const Arguments& /*given*/, Watch& /*watch*/) {
  Json list = Json::array();
  for (const auto& file : canonical_files()) {
    const auto of_file = read_cases(file);
    const Case& first = of_file.front();
    Json variants = Json::array();
    for (const Case& one : of_file) variants.push_back(one.name);
    list.push_back({{"name", first.family},
                    {"answer", first.quasi_static ? "quasi-static" : "dynamic"},
                    {"cases", variants},
                    {"requirement", first.requirement},
                    {"file", file.string()}});
  }
  return list.dump();
}

std::string list_methods(const Arguments& /*given*/, Watch& /*watch*/) {
  Json list = Json::array();
  for (const MethodEntry& method : methods()) {
    list.push_back({{"name", method.name}, {"takes_kappa", method.takes_kappa}, {"summary", method.summary}});
  }
  return list.dump();
}

std::string list_axes(const Arguments& /*given*/, Watch& /*watch*/) {
  Json list = Json::array();
  for (const Axis& axis : axes()) {
    list.push_back({{"name", axis.name},
                    {"range", axis.range.text()},
                    {"meaning", axis.meaning},
                    {"values", axis.values}});
  }
  return list.dump();
}

/// The chosen case is written to `output`, where the case file with the chosen settings belongs.
std::string choose_method(const Arguments& given, Watch& watch) {
  Demand demand{.tolerance = parse_share("tolerance", given.text("tolerance")),
                .real_time = given.flag("realtime"),
                .methods = given.texts("methods"),
                .threads = thread_count(given),
                .all = given.flag("all")};
  demand.against = given.optional("against", &Arguments::text).value_or("");
  if (!given.value("against").is_none() && demand.against != "golden" && demand.against != "truth")
    throw InputError("against = '" + demand.against + "' must be 'golden', 'truth' or None");
  if (const auto budget = given.optional("budget", &Arguments::text))
    demand.budget = parse_time("budget", *budget);
  const std::string name = given.text("case"), output = given.text("output");
  return watch.run([&] {
    const CaseOnMesh problem = with_mesh(find_case(name));
    const Scene scene = make_scene(problem);
    if (scene.settings.quasi_static) require_held(scene);
    const Choice choice = choose(problem, demand, progress_of(watch));
    if (choice.chosen) {
      const Candidate& candidate = choice.attempts[*choice.chosen].candidate;
      write_text_file(output, case_text(problem.description, candidate.choice,
                                        candidate.mesh->problem.description, output));
    }
    return to_json(build_provenance(), scene, choice);
  });
}

std::string verify_cases(const Arguments& given, Watch& watch) {
  require_worker_count(given);
  const VerifyPlan plan{parse_precision(given.text("precision")), given.integer("threads"),
                        given.flag("costs"), processor_named(given.text("device"), "device")};
  const auto names = given.texts("cases");
  const auto results = given.optional("results", &Arguments::text);
  return watch.run([&] {
    std::vector<Scene> scenes;
    for (const Case& one : named_cases(names, comparable, "golden or published value to be compared with"))
      scenes.push_back(held_scene(one));
    if (results) make_folder(*results);
    const Verification found = verify(std::move(scenes), plan, progress_of(watch));
    if (results) write_results(found, *results, build_provenance());
    return to_json(build_provenance(), found.verdicts, found.limits);
  });
}

/// Displacements are an array, or the path of a file.
std::string score_displacements(const Arguments& given, Watch& watch) {
  const NodeMatching matching{given.number("tolerance"), given.text("field")};
  if (!(matching.tolerance > 0.0 && matching.tolerance < 1.0)) {
    throw InputError(
        fmt::format("tolerance = {} must be in (0, 1), a fraction of the diagonal", matching.tolerance));
  }
  const std::string name = given.text("name"), of = given.text("case");
  const py::object displacement = given.value("displacement");
  const bool is_file = py::isinstance<py::str>(displacement);
  const std::string file = is_file ? given.text("displacement") : "";
  const Scene scene = watch.run([&] { return held_scene(find_case(of)); });
  NodalField u;
  if (!is_file) u = nodal_field("displacement", displacement, scene.mesh.points.size());
  return watch.run([&] {
    require_scorable(scene);
    if (is_file) u = read_foreign_displacement(file, scene, matching);
    return to_json(build_provenance(), {score(scene, u, name)}, {});
  });
}

std::string count_operations(const Arguments& /*given*/, Watch& watch) {
  return watch.run([&] {
    auto parts = count_methods();
    const auto laws = count_laws();
    parts.insert(parts.end(), laws.begin(), laws.end());
    return to_json(build_provenance(), parts, count_programs());
  });
}

std::string write_kernel(const Arguments& given, Watch& watch) {
  const KernelRequest request{given.text("method"), given.text("dialect"),
                              given.optional("precision", &Arguments::text).value_or(""),
                              given.optional("material", &Arguments::integer), given.flag("step")};
  const std::string of = given.text("case"), constants = given.text("constants");
  return watch.run([&] {
    const Case description = find_case(of);
    if (!constants.empty()) {
      require_place(constants, description.files);
      write_text_file(constants, kernel_constants(request, description));
    }
    return Json(kernel_source(request, description, build_provenance())).dump();
  });
}

std::string write_mesh(const Arguments& given, Watch& watch) {
  const std::string of = given.text("case"), output = given.text("output");
  MeshFormat as{given.text("format"), {given.text("deck"), given.text("element"), std::nullopt}};
  as.deck.hourglass = given.optional("hourglass", &Arguments::number);
  return watch.run([&] {
    const Scene scene = make_scene(with_mesh(find_case(of)));
    require_place(output, scene.settings.files);
    write_mesh_of(scene, output, as);
    const QualityTable table = quality_table(scene.mesh);
    Json worst = Json::array();
    for (const auto& [number, quality, centre] : table.worst)
      worst.push_back({{"element", number}, {"scaled_jacobian", quality}, {"centre", centre}});
    return Json{{"file", output},
                {"nodes", scene.mesh.points.size()},
                {"elements", scene.mesh.cells.size()},
                {"smallest_scaled_jacobian", table.smallest},
                {"largest_scaled_jacobian", table.largest},
                {"counts", table.counts},
                {"worst", worst}}
        .dump();
  });
}

std::string map_stability(const Arguments& given, Watch& watch) {
  require_worker_count(given);
  const MapPlan plan{given.texts("maps"), given.texts("values"), given.texts("methods"), given.text("folder"),
                     given.integer("threads")};
  const std::string of = given.text("case");
  return watch.run([&] {
    const Case description = find_case(of);
    require_mappable(description);
    const auto [maps, cells, limit] =
        map_failures(description, held_scene(description), plan, build_provenance(), progress_of(watch));
    return to_json(build_provenance(), description, limit, maps, cells);
  });
}

BenchPlan bench_plan(const Arguments& given) {
  BenchPlan plan{.methods = given.texts("methods"), .threads = given.integers("threads")};
  for (const int threads : plan.threads) require_count("threads", threads, 1024);
  for (const auto& precision : given.texts("precision"))
    plan.precisions.push_back(parse_precision(precision));
  plan.settings.repetitions = given.integer("repetitions");
  require_count("repetitions", plan.settings.repetitions, 1'000'000);
  plan.processor = processor_named(given.text("device"), "device");
  return plan;
}

std::string bench_steps(const Arguments& given, Watch& watch) {
  const BenchPlan plan = completed(bench_plan(given));
  const auto names = given.texts("cases");
  const auto elements = given.integers("elements"), cubes = given.integers("cubes");
  return watch.run([&] {
    const auto subjects = bench_subjects(names, elements, cubes);
    MachineSpeed machine;
    const auto records =
        bench_all(subjects, plan, machine, held_scene, progress_of(watch), [](const auto&) {});
    return to_json(build_provenance(), plan, machine, records);
  });
}

std::string bench_rest(const Arguments& given, Watch& watch) {
  const BenchPlan plan = bench_plan(given);
  const auto names = given.texts("cases");
  return watch.run([&] {
    std::vector<Scene> scenes;
    for (const Case& one : cases_for_rest(names)) scenes.push_back(held_scene(one));
    return to_json(build_provenance(),
                   rest_all(scenes, plan, progress_of(watch), [](const auto&, const auto&) {}));
  });
}

std::string bench_bodies(const Arguments& given, Watch& watch) {
  const BenchPlan plan = bench_plan(given);
  const auto names = given.texts("cases");
  const int bodies = given.integer("bodies");
  require_count("bodies", bodies, 1'000'000);
  return watch.run([&] {
    std::vector<Case> cases;
    for (const auto& name : names) cases.push_back(find_case(name));
    return to_json(build_provenance(),
                   bodies_all(cases, bodies, plan, progress_of(watch), [](const auto&) {}));
  });
}

}  // namespace

void add_commands(py::module_& m) {
  using namespace pybind11::literals;
  using Command = std::string (*)(const Arguments&, Watch&);
  const auto add = [&](const char* name, Command command) {
    m.def(
        name,
        [command](const py::dict& arguments, const py::object& progress) {
          Watch watch(progress);
          return command(Arguments(arguments), watch);
        },
        "arguments"_a, "progress"_a, "What the package's function of this name returns, as JSON.");
  };
  m.attr("bench_repetitions") = MeasureSettings{}.repetitions;
  add("cases", cases);
  add("methods", list_methods);
  add("axes", list_axes);
  add("choose", choose_method);
  add("verify", verify_cases);
  add("score", score_displacements);
  add("flops", count_operations);
  add("kernels", write_kernel);
  add("write_mesh", write_mesh);
  add("stability", map_stability);
  add("bench", bench_steps);
  add("bench_rest", bench_rest);
  add("bench_bodies", bench_bodies);
}

}  // namespace sandglass
