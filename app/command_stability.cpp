#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <memory>

#include "app/commands.hpp"
#include "app/machine.hpp"
#include "app/progress.hpp"
#include "app/scene_report.hpp"
#include "app/task_pool.hpp"
#include "app/workspace.hpp"
#include "assembly/method_entry.hpp"
#include "base/error.hpp"
#include "base/names.hpp"
#include "comparison/verdict.hpp"
#include "io/case_file.hpp"
#include "io/new_file.hpp"
#include "io/text_file.hpp"
#include "stability/cell_files.hpp"

namespace sandglass {

namespace {

struct StabilityOptions {
  std::string name;
  std::vector<std::string> maps;
  std::vector<std::string> values;
  std::vector<std::string> methods;
  std::string folder = "build/stability";
  std::string json;
  int threads = 0;
  bool describe = false;
};

/// One cell to compute, unless a file has it.
struct Task {
  std::size_t map;
  std::string method;
  double x;
  double y;
};

std::vector<Map> make_maps(const StabilityOptions& options, const Case& description) {
  std::vector<Map> maps;
  for (const auto& text : options.maps) {
    maps.push_back(parse_map(text));
    require_possible(maps.back(), description);
  }
  if (maps.empty()) maps = usual_maps(description);
  for (const auto& text : options.values) set_values(text, maps);
  return maps;
}

std::vector<std::string> make_methods(const StabilityOptions& options) {
  for (const auto& name : options.methods) method_named(name, "--methods");
  return options.methods.empty() ? method_names() : options.methods;
}

std::vector<Task> make_tasks(const std::vector<Map>& maps, const std::vector<std::string>& methods,
                             const Case& description) {
  std::vector<Task> tasks;
  for (std::size_t m = 0; m < maps.size(); ++m) {
    for (const auto& method : methods) {
      if (!concerns(maps[m], description, method)) continue;
      for (const double y : maps[m].ys) {
        for (const double x : maps[m].xs) tasks.push_back({m, method, x, y});
      }
    }
  }
  return tasks;
}

/// A letter for a cell of a map.
char letter(const Cell& cell) {
  if (cell.refused) return '-';
  if (!cell.finding) return '?';
  switch (*cell.finding) {
    case Finding::good:
      return '.';
    case Finding::not_judged:
      return '~';
    case Finding::inaccurate:
      return 'o';
    case Finding::hourglassing:
      return 'H';
    case Finding::locking:
      return 'L';
    case Finding::inverted:
      return 'I';
    case Finding::unstable:
      return 'U';
    case Finding::no_equilibrium:
      break;
  }
  return 'R';
}

/// One map below the other, as all side by side would be too wide; y points upwards.
void print_map(const Map& map, const std::vector<Cell>& cells) {
  fmt::print("\n{} over {}: {}\n", map.y == nullptr ? "all" : map.y->name, map.x->name,
             fmt::join(map.xs, " "));
  for (std::size_t first = 0; first < cells.size(); first += map.xs.size() * map.ys.size()) {
    fmt::print("{}\n", cells[first].method);
    for (std::size_t j = map.ys.size(); j-- > 0;) {
      fmt::print("{:>10}  ", map.y == nullptr ? "" : fmt::to_string(map.ys[j]));
      for (std::size_t i = 0; i < map.xs.size(); ++i)
        fmt::print("{} ", letter(cells[first + j * map.xs.size() + i]));
      fmt::print("\n");
    }
  }
}

/// The error up to which a method is good on this case, as in `verify`.
double limit_of(const Case& description) {
  const Scene scene = understood_scene(description);
  return good_limit(golden_to_truth(scene, read_references(scene)));
}

void describe_axes() {
  fmt::print("axes of the maps; `--map X,Y` takes two of them, `--values AXIS=V1,V2,...` other values\n\n");
  for (const Axis& axis : axes()) {
    fmt::print("{:<10}{:<12}{}; usually {}\n", axis.name, axis.range.text(), axis.meaning,
               fmt::join(axis.values, " "));
  }
}

int map_stability(const StabilityOptions& options) {
  const Case description = find_case(options.name);
  if (!options.json.empty()) require_place(options.json, description.files);
  if (!description.quasi_static) {
    throw InputError(
        fmt::format("{}: is a dynamic case; all maps, even of motion, start from a quasi-static case",
                    description.file.string()));
  }
  const auto maps = make_maps(options, description);
  const auto tasks = make_tasks(maps, make_methods(options), description);
  const double limit = limit_of(description);
  const CellFiles files(options.folder, description, limit, build_provenance());
  watch_for_interrupt();
  Answers answers;
  std::vector<Cell> found(tasks.size());
  const bool complete = run_tasks("stability", tasks.size(), options.threads, [&](std::size_t n) {
    const auto& [m, method, x, y] = tasks[n];
    if (auto known = files.read(maps[m], method, x, y)) {
      found[n] = std::move(*known);
      return;
    }
    found[n] = compute_cell(maps[m], description, method, x, y, limit, answers);
    files.write(maps[m], found[n]);
  });
  if (!complete) {
    throw ComputationError(fmt::format(
        "stability: interrupted; finished cells are in {}, and the same command resumes from there",
        options.folder));
  }
  std::vector<std::vector<Cell>> cells(maps.size());
  for (std::size_t n = 0; n < tasks.size(); ++n) cells[tasks[n].map].push_back(std::move(found[n]));
  fmt::print(
      "{}: . good, up to {:.3g} % from the golden's element on the same mesh; o inaccurate, H hourglassing, "
      "L locking,\nI inverted, U unstable, R not at rest (no equilibrium), ? the golden's element fails too, "
      "~ it is too "
      "far from the truth to judge, - refused by the method\n",
      description.name, 100.0 * limit);
  for (std::size_t m = 0; m < maps.size(); ++m) print_map(maps[m], cells[m]);
  if (!options.json.empty()) {
    write_text_file(options.json, to_json(build_provenance(), description, limit, maps, cells));
  }
  return 0;
}

}  // namespace

void add_stability_command(CLI::App& app, int& exit_code) {
  auto options = std::make_shared<StabilityOptions>();
  CLI::App* command =
      app.add_subcommand("stability", "map where each method fails, over kappa, load, step, ...");
  command->add_option("CASE", options->name, "name or file of a quasi-static case");
  command
      ->add_option("--map", options->maps,
                   "axes of a map, 'X,Y' or 'X'; may be repeated; default: all usual maps")
      ->allow_extra_args(false);
  command->add_option("--values", options->values, "values of an axis, AXIS=V1,V2,...")
      ->allow_extra_args(false);
  command->add_option("--methods", options->methods, "only these methods, separated by spaces")
      ->type_name("METHOD");
  command->add_option("--folder", options->folder, "folder of finished cells, which are not recomputed")
      ->capture_default_str();
  command->add_option("--json", options->json, "write all maps to this file");
  command->add_option("-j,--threads", options->threads, "runs at the same time; 0 for one per processor")
      ->check(CLI::Range(0, 1024))
      ->capture_default_str();
  command->add_flag("--describe", options->describe, "print the axes with their ranges and usual values");
  command->callback([options, &exit_code] {
    if (options->describe) {
      describe_axes();
      return;
    }
    if (options->name.empty()) throw CLI::RequiredError("CASE");
    exit_code = map_stability(*options);
  });
}

}  // namespace sandglass
