#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <memory>

#include "app/commands.hpp"
#include "app/machine.hpp"
#include "app/progress.hpp"
#include "app/scene_report.hpp"
#include "commands/failure_maps.hpp"
#include "commands/workspace.hpp"
#include "io/new_file.hpp"
#include "io/text_file.hpp"
#include "stability/cell_files.hpp"

namespace sandglass {

namespace {

struct StabilityOptions {
  std::string name;
  MapPlan plan{.folder = "build/stability"};
  std::string json;
  bool describe = false;
};

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
  require_mappable(description);
  const Scene scene = understood_scene(description);
  watch_for_interrupt();
  std::optional<FailureMaps> found;
  {
    Progress progress("stability");
    found = map_failures(description, scene, options.plan, build_provenance(), shown_on(progress));
  }
  const auto& [maps, cells, limit] = *found;
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
      ->add_option("--map", options->plan.maps,
                   "axes of a map, 'X,Y' or 'X'; may be repeated; default: all usual maps")
      ->allow_extra_args(false);
  command->add_option("--values", options->plan.values, "values of an axis, AXIS=V1,V2,...")
      ->allow_extra_args(false);
  command->add_option("--methods", options->plan.methods, "only these methods, separated by spaces")
      ->type_name("METHOD");
  command->add_option("--folder", options->plan.folder, "folder of finished cells, which are not recomputed")
      ->capture_default_str();
  command->add_option("--json", options->json, "write all maps to this file");
  command->add_option("-j,--threads", options->plan.threads, "runs at the same time; 0 for one per processor")
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
