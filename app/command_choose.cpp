#include <fmt/format.h>

#include <memory>

#include "app/choose_table.hpp"
#include "app/commands.hpp"
#include "app/machine.hpp"
#include "app/progress.hpp"
#include "app/scene_report.hpp"
#include "base/error.hpp"
#include "choice/case_writer.hpp"
#include "choice/choose_json.hpp"
#include "commands/execution_options.hpp"
#include "commands/workspace.hpp"
#include "io/case_file.hpp"
#include "io/new_file.hpp"
#include "io/text_file.hpp"
#include "problem/held.hpp"

namespace sandglass {

namespace {

struct ChooseOptions {
  std::string name;
  std::string tolerance = "1%";
  std::string against;
  std::string budget;
  bool real_time = false;
  std::vector<std::string> methods;
  int threads = 1;
  bool all = false;
  std::string output;
  std::string json;
};

void write_chosen(const Case& description, const Choice& choice, const std::string& output) {
  const Candidate& candidate = choice.attempts[*choice.chosen].candidate;
  write_text_file(output,
                  case_text(description, candidate.choice, candidate.mesh->problem.description, output));
  fmt::print("wrote {}\n", output);
}

int run_choose(const ChooseOptions& options) {
  Demand demand{.tolerance = parse_share("--tolerance", options.tolerance),
                .against = options.against,
                .real_time = options.real_time,
                .budget = {},
                .methods = options.methods,
                .threads = options.threads,
                .all = options.all};
  if (!options.budget.empty()) demand.budget = parse_time("--budget", options.budget);
  require_threads(options.threads);
  const CaseOnMesh problem = with_mesh(find_case(options.name));
  const Scene scene = make_scene(problem);
  if (scene.settings.quasi_static) require_held(scene);
  print_understood(problem, scene);
  require_places({options.output, options.json}, problem.description.files);
  watch_for_interrupt();
  std::optional<Choice> choice;
  {
    Progress progress("choose");
    choice = choose(problem, demand, shown_on(progress));
  }
  fmt::print("{}", choose_table(scene, *choice));
  if (!choice->chosen) {
    fmt::print("no method suffices{}\n",
               options.output.empty() ? "" : fmt::format("; {} was not written", options.output));
  }
  if (!options.json.empty()) write_text_file(options.json, to_json(build_provenance(), scene, *choice));
  if (!choice->chosen) return 1;
  if (!options.output.empty()) write_chosen(problem.description, *choice, options.output);
  return 0;
}

}  // namespace

void add_choose_command(CLI::App& app, int& exit_code) {
  auto options = std::make_shared<ChooseOptions>();
  CLI::App* command = app.add_subcommand(
      "choose",
      "find the cheapest method, precision and mesh that are accurate enough for a case on this machine.\n"
      "Tries the cheapest first and prints why others were rejected; exit code 1 if none suffices");
  command->add_option("CASE", options->name, "name or file of a case")->required();
  command
      ->add_option("--tolerance", options->tolerance,
                   "largest error at any node, as a share of the largest imposed displacement: 1% or 0.01")
      ->capture_default_str();
  command
      ->add_option("--against", options->against,
                   "measure errors against the case's stored 'golden' or 'truth'; by default against "
                   "tl-mean-dilatation on the same mesh, computed here")
      ->check(CLI::IsMember({"golden", "truth"}));
  command->add_flag("--realtime", options->real_time, "a simulated second must take at most a second");
  command->add_option("--budget", options->budget,
                      "time that a step or a condensed answer may take: 1ms, 500us");
  command->add_option("-m,--methods", options->methods, "only these methods, separated by spaces")
      ->type_name("METHOD");
  command->add_option("-t,--threads", options->threads, "threads of a step")->capture_default_str();
  command->add_flag("--all", options->all, "try the costlier ones too, and list the rejected ones");
  command->add_option("-o,--output", options->output, "write the chosen settings as a case file for `run`");
  command->add_option("--json", options->json, "write every figure to this file");
  command->callback([options, &exit_code] { exit_code = run_choose(*options); });
}

}  // namespace sandglass
