#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <filesystem>
#include <memory>

#include "app/accuracy_text.hpp"
#include "app/commands.hpp"
#include "app/execution_options.hpp"
#include "app/foreign_files.hpp"
#include "app/machine.hpp"
#include "app/scene_report.hpp"
#include "app/workspace.hpp"
#include "assembly/method_entry.hpp"
#include "base/error.hpp"
#include "base/names.hpp"
#include "comparison/answer.hpp"
#include "comparison/comparison.hpp"
#include "comparison/verdict.hpp"
#include "comparison/verdict_json.hpp"
#include "io/case_file.hpp"
#include "io/new_file.hpp"
#include "io/text_file.hpp"
#include "solve/body.hpp"

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

/// The answer of the mean-dilatation element, for cases without a stored golden. Throws ComputationError if
/// there is none.
Displacements mean_dilatation_answer(const Scene& scene) {
  Observer silent;
  Answer answer = compute_answer(scene, {.method = std::string(golden_method)}, silent);
  if (answer.refused || answer.failure) {
    throw ComputationError(fmt::format("{}: {} found no answer to compare with: {}", scene.settings.name,
                                       golden_method, answer.status));
  }
  return std::move(answer.u);
}

/// The verdict that displacements allow. Without energies, locking is never found.
Finding finding_of(const Scene& scene, const References& references, const Displacements& u) {
  const double unit = displacement_unit(scene, *references.golden);
  Symptoms found = symptoms(scene, u, 0.0, *references.golden, unit);
  found.stiffness_ratio = 1.0;
  return judge(found, golden_to_truth(scene, references));
}

Verdict score(const Scene& scene, const ScoreOptions& options) {
  const References references = read_references(scene);
  const Displacements answer{read_foreign_displacement(options.file, scene, options.matching)};
  Verdict verdict{
      .case_name = scene.settings.name,
      .method = options.name.empty() ? std::filesystem::path(options.file).stem().string() : options.name,
      .precision = "double",
      .status = "ok",
      .golden = accuracy_of(scene, references.comparison, answer, references.golden),
      .truth = accuracy_of(scene, references.comparison, answer, references.truth),
      .family = scene.settings.family,
      .variants = scene.settings.variants};
  if (references.golden) {
    verdict.finding = finding_of(scene, references, answer);
  } else {
    verdict.mean_dilatation =
        accuracy_of(scene, references.comparison, answer, mean_dilatation_answer(scene));
  }
  return verdict;
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
  if (!scene.settings.quasi_static) {
    throw InputError(fmt::format("{}: a dynamic case has no answer to score", scene.settings.file.string()));
  }
  if (!options.json.empty()) {
    auto inputs = scene.settings.files;
    inputs.emplace_back(options.file);
    require_place(options.json, inputs);
  }
  const Verdict verdict = score(scene, options);
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
