#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <memory>
#include <utility>

#include "app/accuracy_text.hpp"
#include "app/commands.hpp"
#include "app/machine.hpp"
#include "app/progress.hpp"
#include "app/scene_report.hpp"
#include "commands/execution_options.hpp"
#include "commands/verify.hpp"
#include "commands/workspace.hpp"
#include "comparison/published_table.hpp"
#include "comparison/verdict_json.hpp"
#include "device/opencl_processor.hpp"
#include "io/new_file.hpp"
#include "io/text_file.hpp"

namespace sandglass {

namespace {

struct VerifyOptions {
  std::vector<std::string> names;
  std::string json;
  std::string results;
  std::string precision = "double";
  std::string device = "cpu";
  int threads = 0;
  bool no_costs = false;
};

/// Whether `a` is closer to its reference than `b`; the reference is the golden if there is one.
bool nearer(const Verdict& a, const Verdict& b) {
  const auto error = [](const Verdict& v) {
    const auto& accuracy = v.golden ? v.golden : v.truth;
    return accuracy && v.ok() ? accuracy->max_relative_error : std::numeric_limits<double>::infinity();
  };
  return error(a) < error(b);
}

/// The rows of a case: every method with its defaults, and below it the best of its kappa curve.
std::vector<const Verdict*> rows_of(const std::vector<Verdict>& verdicts) {
  std::vector<const Verdict*> rows;
  const Verdict* best = nullptr;
  for (const auto& v : verdicts) {
    const bool on_curve = v.kappa && !v.kappa_is_auto;
    if (!on_curve && best != nullptr) rows.push_back(std::exchange(best, nullptr));
    if (!on_curve) {
      rows.push_back(&v);
    } else if (best == nullptr || nearer(v, *best)) {
      best = &v;
    }
  }
  if (best != nullptr) rows.push_back(best);
  return rows;
}

/// The cost and mean length of a step, and the cost of a simulated second.
std::string cost_columns(const Verdict& v) {
  const auto text = [](const std::optional<double>& value, double factor) {
    return value ? fmt::format("{:.3g}", factor * *value) : "-";
  };
  if (!v.step_cost) return fmt::format("{:>8}{:>9}{:>9}", "-", "-", "-");
  const StepCost& cost = *v.step_cost;
  return fmt::format(
      "{:>8}{:>9}{:>9}",
      cost.condensed ? "-" : fmt::format("{:.3g}", 1e9 * cost.seconds / static_cast<double>(v.elements)),
      text(cost.mean_step, 1e3), text(cost.per_simulated_second(), 1.0));
}

void print_verdict(const Verdict& v) {
  const std::string kappa =
      v.kappa ? fmt::format("{} {:.3g}", v.kappa_is_auto ? "auto" : "best", *v.kappa) : "";
  const std::string_view finding = v.finding ? name_of(*v.finding) : "";
  fmt::print("{:<24}{:>13} |{}|{}|{:>8}{:>7}{}{:>8}{:>9.2f}  {}{}\n", v.method, kappa, percents(v.golden),
             percents(v.truth), percent(v.hourglass_energy_ratio), v.operations, cost_columns(v),
             v.search   ? v.search->evaluations
             : v.motion ? v.motion->steps
                        : 0L,
             v.search   ? v.search->seconds
             : v.motion ? v.motion->seconds
                        : 0.0,
             finding, v.ok() ? "" : fmt::format("{}{}", finding.empty() ? "" : "; ", v.status));
}

void print_verdicts(const std::vector<Verdict>& verdicts) {
  const auto in_tables = [](const Verdict& v) { return !v.published.empty(); };
  if (std::all_of(verdicts.begin(), verdicts.end(), in_tables)) return;
  fmt::print(
      "errors in % of the imposed displacement, in motion the largest over time: max over all nodes, max "
      "over the profile, rms;\noperations and ns per element and step, measured as in `bench`; mean step of "
      "the case's own motion, and seconds per\nsimulated second with it; evaluations and seconds of the "
      "static solution, or steps and seconds of a motion, while other\nruns share the machine; finding: good "
      "means at most 1 %, or the golden's own distance from the truth, up to 10 %; larger\nerrors up to "
      "that distance are not judged\n");
  const std::string* case_name = nullptr;
  for (const Verdict* v : rows_of(verdicts)) {
    if (in_tables(*v)) continue;
    if (case_name == nullptr || *case_name != v->case_name) {
      case_name = &v->case_name;
      fmt::print("\n{:<24}{:>13} |{:^27}|{:^27}|{:>8}{:>7}{:>8}{:>9}{:>9}{:>7}{:>10}  {}\n", *case_name,
                 "kappa", "against the golden", "against the truth", "hg/int%", "ops", "ns/step", "step ms",
                 "s/sim. s", v->motion ? "steps" : "evals", "solved, s", "finding");
    }
    print_verdict(*v);
  }
}

void print_limits(const std::vector<LimitCheck>& limits) {
  if (limits.empty()) return;
  fmt::print("\nlimits of the cases\n");
  for (const auto& check : limits) {
    const auto& e = check.expectation;
    const std::string found = check.figure ? fmt::format("{} %", percent(check.figure)) : "no figure";
    const std::string at =
        check.kappa && e.kappa == "best" ? fmt::format(" (kappa {:.4g})", *check.kappa) : "";
    fmt::print("{} {} {} kappa {}: {} against the {} = {}{}, must be {} {} %\n",
               check.holds ? "holds " : "BROKEN", check.case_name, e.method, e.kappa, e.figure, e.reference,
               found, at, e.below ? "at most" : "above", percent(e.below ? e.below : e.above));
  }
}

void print_left_out(const std::vector<Verification::LeftOut>& left_out) {
  if (left_out.empty()) return;
  fmt::print("\nleft out, with their limits\n");
  for (const auto& [case_name, method, reason] : left_out)
    fmt::print("{} {}: {}\n", case_name, method, reason);
}

int run_verify(const VerifyOptions& options) {
  const VerifyPlan plan{parse_precision(options.precision), options.threads, !options.no_costs,
                        processor_named(options.device)};
  watch_for_interrupt();
  std::vector<Scene> scenes;
  for (Case& description :
       named_cases(options.names, comparable, "golden or published value to be compared with")) {
    if (!options.json.empty()) require_place(options.json, description.files);
    scenes.push_back(understood_scene(std::move(description)));
  }
  if (!options.results.empty()) make_folder(options.results);
  std::optional<Verification> found;
  {
    Progress progress("verify");
    found = verify(std::move(scenes), plan, shown_on(progress));
  }
  const auto& limits = found->limits;
  print_verdicts(found->verdicts);
  fmt::print("{}", published_tables(found->verdicts));
  print_limits(limits);
  print_left_out(found->left_out);
  if (plan.precision != Precision::double_precision) {
    fmt::print("\nthe cases' limits are for double precision; none was checked in {}\n", options.precision);
  }
  const Provenance provenance = build_provenance();
  if (!options.json.empty()) write_text_file(options.json, to_json(provenance, found->verdicts, limits));
  if (!options.results.empty()) write_results(*found, options.results, provenance);
  return std::all_of(limits.begin(), limits.end(), [](const auto& check) { return check.holds; }) ? 0 : 1;
}

}  // namespace

void add_verify_command(CLI::App& app, int& exit_code) {
  auto options = std::make_shared<VerifyOptions>();
  CLI::App* command = app.add_subcommand(
      "verify", "compare all methods with the references; exit code 1 if a limit is broken");
  command->add_option("CASE", options->names, "names or files of cases; default: all canonical ones");
  command->add_option("--json", options->json, "write every figure to this file");
  command->add_option("--results", options->results, "write the final state of every run to this folder");
  command
      ->add_option("-p,--precision", options->precision,
                   "numbers to compute in, 'double' or 'float'; limits are checked in double only")
      ->capture_default_str();
  add_device_option(*command, options->device);
  command->add_flag("--no-costs", options->no_costs, "do not measure the cost of steps");
  command->add_option("-j,--threads", options->threads, "runs at the same time; 0: one per processor")
      ->check(CLI::Range(0, 1024))
      ->capture_default_str();
  command->callback([options, &exit_code] { exit_code = run_verify(*options); });
}

}  // namespace sandglass
