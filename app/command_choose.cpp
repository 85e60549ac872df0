#include <fmt/format.h>

#include <charconv>
#include <memory>

#include "app/commands.hpp"
#include "app/execution_options.hpp"
#include "app/machine.hpp"
#include "app/progress.hpp"
#include "app/workspace.hpp"
#include "base/error.hpp"
#include "choice/case_writer.hpp"
#include "choice/choose_json.hpp"
#include "io/case_file.hpp"
#include "io/text_file.hpp"

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

/// The value of --budget in seconds.
double parse_budget(const std::string& text) {
  if (const auto quantity = parse_quantity(text)) {
    for (const auto& [unit, seconds] : {std::pair{"", 1.0}, {"s", 1.0}, {"ms", 1e-3}, {"us", 1e-6}}) {
      if (quantity->unit == unit) return quantity->value * seconds;
    }
  }
  throw InputError(fmt::format(
      "--budget = '{}' must be a positive time in s, ms or us, such as 1ms; without a unit it is in s",
      text));
}

std::string cost_columns(const std::optional<StepCost>& cost) {
  if (!cost) return fmt::format("{:>10}{:>10}{:>11}", "-", "-", "-");
  return fmt::format("{:>10.3g}{:>10}{:>11.3g}", 1e6 * cost->seconds,
                     cost->mean_step ? fmt::format("{:.3g}", 1e3 * *cost->mean_step) : "-",
                     *cost->per_simulated_second());
}

std::string answer_columns(const Evaluation& evaluation) {
  const auto& [error, smallest_jacobian, per_simulated_second, reason] = evaluation;
  return fmt::format("{:>9}{:>9}{:>8}",
                     per_simulated_second ? fmt::format("{:.3g}", *per_simulated_second) : "-",
                     error ? fmt::format("{:.3g}", 100.0 * *error) : "-",
                     smallest_jacobian ? fmt::format("{:.2g}", *smallest_jacobian) : "-");
}

void print_other_meshes(const Scene& scene, const Choice& choice) {
  if (std::holds_alternative<MeshFile>(scene.description.mesh)) {
    fmt::print("the mesh comes from a file: no coarser one was looked at\n");
  }
  for (const auto& [mesh, evaluation, kept] : choice.others) {
    fmt::print("tried: {}: {}{}{}\n", mesh,
               evaluation.error
                   ? fmt::format("the golden's own element is {:.3g} % off", 100.0 * *evaluation.error)
                   : "",
               evaluation.error && !kept ? ", " : "", kept ? "" : evaluation.reason);
  }
}

/// The rows that say something: what was tried, and what can never be taken. Rungs of a method that were
/// refused before any figure was found, for the same reason, are one row.
void print_attempts(const Choice& choice) {
  fmt::print("{:<46}{:<50}{:>10}{:>10}{:>11}{:>9}{:>9}{:>8}  {}\n", "method and numbers", "mesh", "us/step",
             "step ms", "s/sim. s", "run", "error %", "det F", "outcome");
  long not_tried = 0;
  std::string last;
  for (const auto& [rung, cost, evaluation, outcome] : choice.attempts) {
    if (outcome == Outcome::not_tried) {
      ++not_tried;
      continue;
    }
    const std::string key = rung.choice.method + evaluation.reason;
    if (!cost && key == last) continue;
    last = cost ? "" : key;
    fmt::print("{:<46}{:<50}{}{}  {}{}{}\n", name_of(rung), rung.mesh->name(), cost_columns(cost),
               answer_columns(evaluation), name_of(outcome), evaluation.reason.empty() ? "" : ": ",
               evaluation.reason);
  }
  if (not_tried > 0) fmt::print("{} dearer ones were not tried; --all tries them\n", not_tried);
}

void print_choice(const Scene& scene, const Choice& choice, const std::string& output) {
  const Demand& demand = choice.demand;
  fmt::print("{}: at most {:.3g} % of the imposed displacement from the {}{}, at every node{}{}\n",
             scene.description.name, 100.0 * demand.tolerance, choice.reference.name,
             demand.against.empty() ? " element's answer on the same mesh" : "",
             demand.real_time ? ", in real time" : "",
             demand.budget ? fmt::format(", {:.3g} ms a step or answer", 1e3 * *demand.budget) : "");
  fmt::print(
      "us/step: median of a step, or of a condensed answer, on this machine with {} thread{}; s/sim. s: wall "
      "time of a simulated\nsecond at the mean step of the case's own motion, or of {:.0f} condensed "
      "answers: what a "
      "real-time "
      "loop pays, and the order of the rows; run: what the run of a motion took\n",
      demand.threads, demand.threads == 1 ? "" : "s", answers_per_second);
  print_other_meshes(scene, choice);
  print_attempts(choice);
  for (const auto& remark : remarks(choice)) fmt::print("note: {}\n", remark);
  if (!choice.chosen) {
    fmt::print("nothing suffices{}\n", output.empty() ? "" : fmt::format("; {} was not written", output));
    return;
  }
  const Attempt& chosen = choice.attempts[*choice.chosen];
  fmt::print("choose {}, {}: {:.4g} % at most, {:.3g} s for a simulated second\n", name_of(chosen.rung),
             chosen.rung.mesh->name(), 100.0 * *chosen.evaluation.error,
             *chosen.cost->per_simulated_second());
}

void write_chosen(const Scene& scene, const Choice& choice, const std::string& output) {
  const Rung& rung = choice.attempts[*choice.chosen].rung;
  write_text_file(output, case_text(scene.description, rung.choice, rung.mesh->scene.description, output));
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
  if (!options.budget.empty()) demand.budget = parse_budget(options.budget);
  require_threads(options.threads);
  for (const auto& place : {options.output, options.json}) {
    if (!place.empty()) require_place(place);
  }
  const Scene scene = read_scene(find_case(options.name));
  std::error_code ignored;
  if (std::filesystem::equivalent(options.output, scene.description.file, ignored)) {
    throw InputError(
        fmt::format("--output = '{}' is the case itself; it must be another file", options.output));
  }
  watch_for_interrupt();
  std::optional<Choice> choice;
  {
    Progress progress("choose");
    choice = choose(scene, demand, [&](double share, const std::string& remark) {
      progress.show(share, remark);
      return !interrupted();
    });
  }
  print_choice(scene, *choice, options.output);
  if (!options.json.empty()) write_text_file(options.json, to_json(build_provenance(), scene, *choice));
  if (!choice->chosen) return 1;
  if (!options.output.empty()) write_chosen(scene, *choice, options.output);
  return 0;
}

}  // namespace

void add_choose_command(CLI::App& app, int& exit_code) {
  auto options = std::make_shared<ChooseOptions>();
  CLI::App* command = app.add_subcommand(
      "choose",
      "the cheapest method, precision and mesh that is accurate enough for a case on this machine.\n"
      "Tries them from the cheapest on and tells why each was refused; exit code 1 when nothing suffices");
  command->add_option("CASE", options->name, "name or file of a case")->required();
  command
      ->add_option("--tolerance", options->tolerance,
                   "largest error at any node, of the largest imposed displacement: 1% or 0.01")
      ->capture_default_str();
  command
      ->add_option("--against", options->against,
                   "measure errors against the case's stored 'golden' or 'truth'; without it against "
                   "tl-mean-dilatation on the same mesh, computed here")
      ->check(CLI::IsMember({"golden", "truth"}));
  command->add_flag("--realtime", options->real_time, "a simulated second must take at most a second");
  command->add_option("--budget", options->budget,
                      "time that a step or a condensed answer may take: 1ms, 500us");
  command->add_option("-m,--methods", options->methods, "only these methods, with spaces between");
  command->add_option("-t,--threads", options->threads, "threads of a step")->capture_default_str();
  command->add_flag("--all", options->all, "try the dearer ones too");
  command->add_option("-o,--output", options->output,
                      "write the chosen settings as a case file that `run` takes");
  command->add_option("--json", options->json, "write every figure to this file");
  command->callback([options, &exit_code] { exit_code = run_choose(*options); });
}

}  // namespace sandglass
