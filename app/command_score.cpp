#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <filesystem>
#include <memory>

#include "app/accuracy_text.hpp"
#include "app/commands.hpp"
#include "app/machine.hpp"
#include "app/scene_report.hpp"
#include "base/error.hpp"
#include "base/names.hpp"
#include "commands/execution_options.hpp"
#include "commands/foreign_files.hpp"
#include "commands/score.hpp"
#include "commands/workspace.hpp"
#include "comparison/verdict_json.hpp"
#include "io/new_file.hpp"
#include "io/text_file.hpp"

namespace sandglass {

namespace {

struct ScoreOptions {
  std::string file;
  std::string case_name;
  std::string name;
  std::string json;
  std::vector<std::string> limits;
  std::string against = "golden";
  NodeMatching matching;
};

/// The largest allowed value of a figure.
struct Limit {
  std::string figure;
  double most;
};

constexpr std::array figures{"max", "profile", "rms"};

/// The value of --limit, such as "max=2%". Throws InputError for anything else.
Limit parse_limit(const std::string& text) {
  const std::size_t end = text.find('=');
  const std::string figure = text.substr(0, end);
  if (std::find(figures.begin(), figures.end(), figure) == figures.end()) {
    throw InputError(fmt::format("--limit '{}': '{}' is not a figure; {}", text, figure,
                                 suggestion(figure, {figures.begin(), figures.end()})));
  }
  if (end == std::string::npos) {
    throw InputError(
        fmt::format("--limit '{}' needs a value, such as {}=2% or {}=0.02", text, figure, figure));
  }
  return {figure, parse_share(fmt::format("--limit {}", figure).c_str(), text.substr(end + 1))};
}

void print(const Verdict& verdict) {
  const std::string of = verdict.method == verdict.case_name ? "" : verdict.method + ", ";
  fmt::print("{}: {}errors in % of the imposed displacement\n{:<36}{:>9}{:>9}{:>9}\n", verdict.case_name, of,
             "", "max", "profile", "rms");
  const auto row = [](std::string_view reference, const std::optional<Accuracy>& accuracy) {
    if (accuracy) fmt::print("{:<36}{}\n", fmt::format("against the {}", reference), percents(accuracy));
  };
  row("golden", verdict.golden);
  row("mean-dilatation element", verdict.mean_dilatation);
  row("truth", verdict.truth);
  if (verdict.finding) fmt::print("finding: {}\n", name_of(*verdict.finding));
}

/// Prints whether each limit holds, against the golden (the mean-dilatation element in a case without one) or
/// the truth. Returns whether all do. Throws InputError for a figure that the case lacks.
bool check(const std::vector<Limit>& limits, const Verdict& verdict, const std::string& against) {
  const std::optional<Accuracy>& found = against == "truth" ? verdict.truth
                                         : verdict.golden   ? verdict.golden
                                                            : verdict.mean_dilatation;
  if (!found) throw InputError(fmt::format("--against truth: {} has no stored truth", verdict.case_name));
  const Accuracy& accuracy = *found;
  const std::string reference = &found == &verdict.mean_dilatation ? "mean-dilatation element" : against;
  bool all_hold = true;
  for (const auto& [figure, most] : limits) {
    if (figure == "profile" && !accuracy.profile_relative_error) {
      throw InputError(fmt::format("--limit profile: {} has no [profile]", verdict.case_name));
    }
    const double error = figure == "max"   ? accuracy.max_relative_error
                         : figure == "rms" ? accuracy.rms_relative_error
                                           : *accuracy.profile_relative_error;
    const bool holds = error <= most;  // a NaN breaks its limit
    fmt::print("limit {}: {} error against the {} is {} %, at most {} % allowed\n", holds ? "kept" : "BROKEN",
               figure, reference, percent(error), percent(most));
    all_hold = all_hold && holds;
  }
  return all_hold;
}

int run(const ScoreOptions& options) {
  std::vector<Limit> limits;
  for (const auto& text : options.limits) limits.push_back(parse_limit(text));
  if (!(options.matching.tolerance > 0.0 && options.matching.tolerance < 1.0)) {
    throw InputError(fmt::format("--tolerance = {} must be in (0, 1), a fraction of the diagonal",
                                 options.matching.tolerance));
  }
  if (options.name.find('/') != std::string::npos) throw InputError("--name must have no '/'");
  const Scene scene = understood_scene(find_case(options.case_name));
  require_scorable(scene);
  if (!options.json.empty()) {
    auto inputs = scene.settings.files;
    inputs.emplace_back(options.file);
    require_place(options.json, inputs);
  }
  const NodalField u = read_foreign_displacement(options.file, scene, options.matching);
  const Verdict verdict = score(
      scene, u, options.name.empty() ? std::filesystem::path(options.file).stem().string() : options.name);
  print(verdict);
  const bool holds = check(limits, verdict, options.against);
  if (!options.json.empty()) write_text_file(options.json, to_json(build_provenance(), {verdict}, {}));
  return holds ? 0 : 1;
}

}  // namespace

void add_score_command(CLI::App& app, int& exit_code) {
  auto options = std::make_shared<ScoreOptions>();
  CLI::App* command =
      app.add_subcommand("score", "compare the displacements of any program with the references");
  command
      ->add_option("FILE", options->file,
                   "displacements from Sandglass or another program; exchange/README.md lists the formats")
      ->required();
  command->add_option("--case", options->case_name, "name or file of their case")
      ->type_name("CASE")
      ->required();
  command->add_option("--name", options->name, "name of the method; default: the name of the file");
  command->add_option("--field", options->matching.field, "name of the displacements in the file");
  command
      ->add_option("--tolerance", options->matching.tolerance,
                   "nodes closer than this are the same, as a fraction of the diagonal of the mesh")
      ->capture_default_str();
  command->add_option("--json", options->json, "write the figures to this file, as `verify --json` does");
  command
      ->add_option("--limit", options->limits,
                   "FIGURE=SHARE, such as max=2%: exit code 1 if an error is larger; the figures are max, "
                   "profile and rms, and --limit may be given for each")
      ->type_name("FIGURE=SHARE")
      ->allow_extra_args(false);
  command
      ->add_option("--against", options->against,
                   "reference of the limits: 'golden' (tl-mean-dilatation if the case has none) or 'truth'")
      ->check(CLI::IsMember({"golden", "truth"}))
      ->capture_default_str();
  command->callback([options, &exit_code] { exit_code = run(*options); });
}

}  // namespace sandglass
