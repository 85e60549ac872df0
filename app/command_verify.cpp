#include <fmt/format.h>

#include <deque>
#include <filesystem>
#include <limits>
#include <memory>
#include <utility>

#include "app/accuracy_text.hpp"
#include "app/commands.hpp"
#include "app/execution_options.hpp"
#include "app/machine.hpp"
#include "app/progress.hpp"
#include "app/step_costs.hpp"
#include "app/task_pool.hpp"
#include "app/workspace.hpp"
#include "assembly/method_entry.hpp"
#include "assembly/processor.hpp"
#include "base/error.hpp"
#include "comparison/published_table.hpp"
#include "comparison/verdict.hpp"
#include "comparison/verdict_json.hpp"
#include "device/opencl_processor.hpp"
#include "io/case_file.hpp"
#include "io/new_file.hpp"
#include "io/result_file.hpp"
#include "io/text_file.hpp"
#include "solve/frame.hpp"

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

/// A scene and its references.
struct Subject {
  Scene scene;
  References references;
};

/// One run.
struct Task {
  const Subject* subject;
  MethodChoice choice;
};

std::deque<Subject> read_subjects(const std::vector<std::string>& names) {
  std::deque<Subject> subjects;  // a deque, because tasks point into it
  const auto comparable = [](const Case& description) {
    if (description.quasi_static) return true;
    const Comparison comparison = read_comparison(description);
    return std::filesystem::exists(comparison.golden) || !comparison.published.empty();
  };
  for (auto& scene : read_scenes(names, comparable, "golden or published value to be compared with")) {
    References references = read_references(scene);
    subjects.push_back({std::move(scene), std::move(references)});
  }
  return subjects;
}

/// The limits of a case for methods that are computed here: a device may refuse some.
std::vector<Expectation> checked_limits(const Subject& subject, const std::vector<Task>& tasks) {
  std::vector<Expectation> checked = subject.references.comparison.expectations;
  std::erase_if(checked, [&](const Expectation& expectation) {
    return std::ranges::none_of(tasks, [&](const Task& task) {
      return task.subject == &subject && task.choice.method == expectation.method;
    });
  });
  return checked;
}

/// Every method on every scene, methods with a kappa at `auto` and along the case's kappa curve.
std::vector<Task> make_tasks(const std::deque<Subject>& subjects, Precision precision,
                             const std::shared_ptr<const Processor>& processor) {
  std::vector<Task> tasks;
  for (const auto& subject : subjects) {
    for (const MethodEntry& method : methods()) {
      if (method.is_condensed && !subject.scene.settings.quasi_static) continue;  // it has no motion
      MethodChoice choice{.method = std::string(method.name), .precision = precision, .processor = processor};
      if (processor && !processor->refusal(subject.scene.materials, choice).empty()) continue;
      tasks.push_back({&subject, choice});
      // A condensed method has the curve of the method that it condenses.
      if (!method.kappa_affects_equilibrium || method.is_condensed) continue;
      for (const double kappa : subject.references.comparison.kappas) {
        choice.kappa = kappa;
        tasks.push_back({&subject, choice});
      }
    }
  }
  return tasks;
}

/// The final state of a run as a result file, for pictures.
void write_result(const Task& task, const Displacements& u, const std::string& folder) {
  const Model model(task.subject->scene, task.choice);
  const std::string kappa = task.choice.kappa ? fmt::format(".{}", *task.choice.kappa) : "";
  const auto path = std::filesystem::path(folder) /
                    fmt::format("{}.{}{}.h5", task.subject->scene.settings.name, task.choice.method, kappa);
  ResultWriter writer(model, path, build_provenance());
  writer.frame(static_frame(model, 0.0, NodalField(u.back().size())));
  writer.frame(static_frame(model, 1.0, u.back()));
  writer.commit("complete");
}

/// The results of the tasks, in their order.
struct Outcome {
  std::vector<Verdict> verdicts;
  std::vector<Displacements> answers;  // empty if there is none
};

/// Runs all tasks on a few threads. Runs are independent and deterministic; only their order in time is not.
Outcome run_all(const std::vector<Task>& tasks, const VerifyOptions& options) {
  Outcome outcome{std::vector<Verdict>(tasks.size()), std::vector<Displacements>(tasks.size())};
  const bool complete = run_tasks("verify", tasks.size(), options.threads, [&](std::size_t n) {
    outcome.verdicts[n] = run_and_compare(tasks[n].subject->scene, tasks[n].subject->references,
                                          tasks[n].choice, outcome.answers[n]);
  });
  if (!complete) throw ComputationError("verify: interrupted; nothing was written");
  return outcome;
}

/// Measures the cost of steps, except in the cases with published values.
void add_step_costs(const std::vector<Task>& tasks, Outcome& outcome, int threads) {
  std::vector<VerifiedRun> runs;
  for (std::size_t n = 0; n < tasks.size(); ++n) {
    const auto& [subject, choice] = tasks[n];
    if (!outcome.verdicts[n].published.empty()) continue;
    runs.push_back({&subject->scene, choice, &outcome.answers[n], &outcome.verdicts[n]});
  }
  add_step_costs(runs, threads);
}

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
      "means at most 1 %, or the golden's own distance from the truth, up to 10 %; beyond, up to "
      "that\ndistance: not "
      "judged\n");
  const std::string* case_name = nullptr;
  for (const Verdict* v : rows_of(verdicts)) {
    if (in_tables(*v)) continue;
    if (case_name == nullptr || *case_name != v->case_name) {
      case_name = &v->case_name;
      fmt::print("\n{:<24}{:>13} |{:^27}|{:^27}|{:>8}{:>7}{:>8}{:>9}{:>9}{:>8}{:>9}  {}\n", *case_name,
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

int verify(const VerifyOptions& options) {
  const Precision precision = parse_precision(options.precision);
  watch_for_interrupt();
  const auto subjects = read_subjects(options.names);
  for (const auto& subject : subjects) {
    if (!options.json.empty()) require_place(options.json, subject.scene.settings.files);
  }
  if (!options.results.empty()) make_folder(options.results);
  const auto tasks = make_tasks(subjects, precision, processor_named(options.device));
  Outcome outcome = run_all(tasks, options);
  if (!options.no_costs && options.device == "cpu") add_step_costs(tasks, outcome, options.threads);
  const auto& [verdicts, answers] = outcome;
  std::vector<LimitCheck> limits;
  for (const auto& subject : subjects) {
    if (precision != Precision::double_precision) break;
    const auto checks = check_limits(subject.scene.settings.name, checked_limits(subject, tasks), verdicts);
    limits.insert(limits.end(), checks.begin(), checks.end());
  }
  print_verdicts(verdicts);
  fmt::print("{}", published_tables(verdicts));
  print_limits(limits);
  if (precision != Precision::double_precision) {
    fmt::print("\nthe cases' limits are for double precision; none was checked in {}\n", options.precision);
  }
  if (!options.json.empty()) write_text_file(options.json, to_json(build_provenance(), verdicts, limits));
  for (std::size_t n = 0; n < tasks.size() && !options.results.empty(); ++n) {
    if (!answers[n].empty()) write_result(tasks[n], answers[n], options.results);
  }
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
  command->callback([options, &exit_code] { exit_code = verify(*options); });
}

}  // namespace sandglass
