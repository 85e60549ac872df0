#include <fmt/format.h>

#include <filesystem>
#include <memory>

#include "app/accuracy_text.hpp"
#include "app/commands.hpp"
#include "app/foreign_files.hpp"
#include "app/machine.hpp"
#include "app/workspace.hpp"
#include "assembly/method_entry.hpp"
#include "base/error.hpp"
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
  NodeMatching matching;
};

/// The answer of the golden's explicit twin, for cases that have no stored one. Throws ComputationError when
/// it finds none.
Displacements twin_of(const Scene& scene) {
  Observer silent;
  Answer answer = compute_answer(scene, {.method = std::string(golden_method)}, silent);
  if (answer.refused || answer.failure) {
    throw ComputationError(fmt::format("{}: {} finds no answer to compare with: {}", scene.description.name,
                                       golden_method, answer.status));
  }
  return std::move(answer.u);
}

/// What displacements alone tell: how much work they took is not known, so that locking is not told.
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
      .case_name = scene.description.name,
      .method = options.name.empty() ? std::filesystem::path(options.file).stem().string() : options.name,
      .precision = "double",
      .status = "ok",
      .golden = accuracy_of(scene, references.comparison, answer, references.golden),
      .truth = accuracy_of(scene, references.comparison, answer, references.truth),
      .family = scene.description.family,
      .variants = scene.description.variants};
  if (references.golden) {
    verdict.finding = finding_of(scene, references, answer);
  } else {
    verdict.twin = accuracy_of(scene, references.comparison, answer, twin_of(scene));
  }
  return verdict;
}

void print(const Verdict& verdict) {
  fmt::print("{}: {}, errors in % of the imposed displacement\n{:<28}{:>9}{:>9}{:>9}\n", verdict.case_name,
             verdict.method, "", "max", "profile", "rms");
  const auto row = [](std::string_view reference, const std::optional<Accuracy>& accuracy) {
    if (accuracy) fmt::print("{:<28}{}\n", fmt::format("against the {}", reference), percents(accuracy));
  };
  row("golden", verdict.golden);
  row("golden's twin (computed)", verdict.twin);
  row("truth", verdict.truth);
  if (verdict.finding) fmt::print("finding: {}\n", name_of(*verdict.finding));
}

void run(const ScoreOptions& options) {
  if (!(options.matching.tolerance > 0.0 && options.matching.tolerance < 1.0)) {
    throw InputError(fmt::format("--tolerance = {} must be in (0, 1), a fraction of the diagonal",
                                 options.matching.tolerance));
  }
  if (options.name.find('/') != std::string::npos) throw InputError("--name must have no '/'");
  const Scene scene = read_scene(find_case(options.case_name));
  if (!scene.description.quasi_static) {
    throw InputError(
        fmt::format("{}: a dynamic case has no answer to score", scene.description.file.string()));
  }
  if (!options.json.empty()) require_place(options.json);
  const Verdict verdict = score(scene, options);
  print(verdict);
  if (!options.json.empty()) write_text_file(options.json, to_json(build_provenance(), {verdict}, {}));
}

}  // namespace

void add_score_command(CLI::App& app) {
  auto options = std::make_shared<ScoreOptions>();
  CLI::App* command =
      app.add_subcommand("score", "how near displacements of any program are to the references");
  command
      ->add_option("FILE", options->file,
                   "displacements, of Sandglass or of another program; exchange/README.md lists the formats")
      ->required();
  command->add_option("--case", options->case_name, "name or file of the case that they answer")->required();
  command->add_option("--name", options->name, "what the method is called; the file's name when left out");
  command->add_option("--field", options->matching.field, "name of the displacements in the file");
  command
      ->add_option("--tolerance", options->matching.tolerance,
                   "distance at which two nodes are one, as a fraction of the diagonal of the nodes")
      ->capture_default_str();
  command->add_option("--json", options->json, "write the figures to this file, as `verify --json` does");
  command->callback([options] { run(*options); });
}

}  // namespace sandglass
