#include <fmt/format.h>

#include <algorithm>
#include <memory>

#include "app/checkpoint_keeper.hpp"
#include "app/commands.hpp"
#include "app/execution_options.hpp"
#include "app/kappa_option.hpp"
#include "app/machine.hpp"
#include "app/progress.hpp"
#include "app/workspace.hpp"
#include "assembly/method_entry.hpp"
#include "base/error.hpp"
#include "comparison/comparison.hpp"
#include "comparison/verdict.hpp"
#include "io/case_file.hpp"
#include "io/case_keys.hpp"
#include "io/result_file.hpp"
#include "solve/central_difference.hpp"
#include "solve/error_estimate.hpp"
#include "solve/relaxation.hpp"
#include "solve/sleep.hpp"
#include "solve/truth_estimate.hpp"

namespace sandglass {

namespace {

struct RunOptions {
  std::string name;
  std::optional<std::string> method = {};
  std::optional<std::string> kappa = {};
  std::optional<std::string> kappa_modulus = {};
  std::optional<std::string> precision = {};
  std::optional<std::string> accuracy = {};
  std::optional<std::string> sleep = {};
  int threads = 1;
  std::string output;
  std::string checkpoint;
  double checkpoint_every = 60.0;
  std::string estimate;
  bool describe = false;
};

/// Writes frames and history to the result file, keeps the run, shows progress, and ends on Ctrl-C.
class RunObserver final : public Observer {
 public:
  /// `writer` and `keeper` may be null. What a run that goes on told before goes into its result first.
  RunObserver(const std::string& title, ResultWriter* writer, CheckpointKeeper* keeper)
      : progress_(title), writer_(writer) {
    if (keeper != nullptr) {
      for (const auto& told : keeper->run().frames) frame(told);
      for (const auto& row : keeper->run().history) history(row);
    }
    keeper_ = keeper;
  }

  void frame(const Frame& frame) override {
    if (writer_ != nullptr) writer_->frame(frame);
    if (keeper_ != nullptr) keeper_->frame(frame);
    levels_ = frame.levels;
  }
  void history(const HistoryRow& row) override {
    if (writer_ != nullptr) writer_->history(row);
    if (keeper_ != nullptr) keeper_->history(row);
    last_ = row;
  }
  void resumable(const std::function<Checkpoint()>& checkpoint) override {
    if (keeper_ != nullptr) keeper_->resumable(checkpoint);
  }
  bool proceed(long step, double share, double residual) override {
    progress_.show(share, fmt::format("step {}, residual {:.1e}", step, residual));
    return !interrupted();
  }
  const HistoryRow& last() const { return last_; }
  const std::vector<double>& levels() const { return levels_; }

 private:
  Progress progress_;
  ResultWriter* writer_;
  CheckpointKeeper* keeper_ = nullptr;
  HistoryRow last_{};
  std::vector<double> levels_;
};

std::string kappa_text(const Model& model) {
  const auto& choice = model.choice();
  const MethodEntry& method = method_named(choice.method);
  if (!method.takes_kappa) return "";
  const auto automatic = method.auto_kappa(
      elastic_law(kernel_law(model.scene().description.materials.front().law)), choice.kappa_modulus);
  const double value = choice.kappa.value_or(automatic.value_or(0.0));
  return fmt::format("{:.6g}{}{}", value, choice.kappa ? "" : " (auto)",
                     choice.kappa_modulus == KappaModulus::shear ? " of the shear modulus" : "");
}

Provenance provenance(const Model& model) {
  Provenance attributes = build_provenance();
  attributes.insert(attributes.end(), {{"method", model.choice().method},
                                       {"kappa", kappa_text(model)},
                                       {"precision", std::string(name_of(model.choice().precision))}});
  return attributes;
}

void print_energies(const Scene& scene, const HistoryRow& row) {
  fmt::print("energies (J): strain {:.6g}, hourglass {:.6g}", row.strain, row.hourglass);
  // In a relaxation part of the external work is damped away, so that there its sum tells nothing.
  if (!scene.description.quasi_static) {
    fmt::print(", kinetic {:.6g}, work of the imposed displacements {:.6g}", row.kinetic, row.external_work);
    if (row.adaption != 0.0) fmt::print(", brought by changes of levels {:.3g}", row.adaption);
  }
  fmt::print("\n");
}

/// The references of a scene; one that belongs to another case is told, not fatal: a case may be edited and
/// run.
References references_to_show(const Scene& scene) {
  try {
    return read_references(scene);
  } catch (const InputError& error) {
    fmt::print(stderr, "note: not compared: {}\n", error.what());
    return {};
  }
}

void print_accuracy(const Scene& scene, const NodalField& u) {
  const References references = references_to_show(scene);
  const auto print = [&](const char* name, const std::optional<Displacements>& reference) {
    const auto figures = accuracy_of(scene, references.comparison, {u}, reference);
    if (!figures) return;
    fmt::print("against the {}: max {:.4g} %, rms {:.4g} % of the imposed displacement\n", name,
               100.0 * figures->max_relative_error, 100.0 * figures->rms_relative_error);
  };
  print("golden", references.golden);
  print("truth", references.truth);
}

/// How many elements of an adaptive method stand at each of its levels, and what share of the time it took to
/// choose them.
void print_levels(const std::string& name, const std::vector<double>& levels, double share_of_time) {
  if (levels.empty()) return;
  std::string text;
  double level = 0.0;
  for (const auto& method : method_named(name).levels) {
    const auto count = static_cast<double>(std::count(levels.begin(), levels.end(), level++));
    text += fmt::format("{}{:.3g} % {}", text.empty() ? "" : ", ",
                        100.0 * count / static_cast<double>(levels.size()), method);
  }
  fmt::print("elements: {}; chosen in {:.2g} % of the time\n", text, 100.0 * share_of_time);
}

/// Prints the estimates that are asked for: against the golden's element on the same mesh, or the truth.
void print_estimates(const RunOptions& options, const Model& model, const NodalField& u) {
  const double unit = displacement_unit(model.scene(), u);
  const auto print = [&](std::string_view against, double largest, double rms, const std::string& how) {
    fmt::print("estimated error against {}: max {:.4g} %, rms {:.4g} % of the {} displacement, {}\n", against,
               100.0 * largest / unit, 100.0 * rms / unit,
               largest_imposed(model.scene()) > 0.0 ? "imposed" : "largest", how);
  };
  if (options.estimate == "golden") {
    const ErrorEstimate estimate = estimate_error(model, u);
    print(golden_method, estimate.largest, estimate.rms,
          fmt::format("after {} evaluations", estimate.evaluations));
  } else if (options.estimate == "truth") {
    const TruthEstimate estimate = estimate_truth_error(model, u);
    print("the truth", estimate.largest, estimate.rms,
          fmt::format("from meshes of up to {} elements", estimate.elements));
    if (!estimate.remark.empty()) fmt::print("note: refined once instead of twice: {}\n", estimate.remark);
  }
}

/// `asleep`: steps had different numbers of elements.
void print_time(double seconds, long steps, std::size_t elements, bool went_on, bool asleep) {
  if (went_on || asleep) {
    fmt::print("wall time {:.3g} s{}\n", seconds, went_on ? " since the checkpoint" : "");
    return;
  }
  fmt::print("wall time {:.3g} s, {:.4g} ns per element and step\n", seconds,
             1e9 * seconds / static_cast<double>(std::max(steps, 1L)) / static_cast<double>(elements));
}

/// The options that were given.
struct Given {
  std::optional<Precision> precision;
  std::optional<std::optional<double>> kappa;
  std::optional<KappaModulus> kappa_modulus;
  std::optional<double> accuracy;
  std::optional<double> sleep;
};

Given parse(const RunOptions& options) {
  Given given;
  if (options.precision) given.precision = parse_precision(*options.precision);
  if (options.kappa) given.kappa = parse_kappa(*options.kappa);
  if (options.kappa_modulus) given.kappa_modulus = parse_kappa_modulus(*options.kappa_modulus);
  if (options.accuracy) given.accuracy = parse_share("--accuracy", *options.accuracy);
  if (options.sleep) given.sleep = parse_share("--sleep", *options.sleep);
  return given;
}

/// What the case says of its method, and before it what the options say. What the case says of kappa is about
/// its own method, not about one that an option names.
MethodChoice choose_method(const RunOptions& options, const Given& given, const Case& description) {
  MethodChoice choice = method_of(description, options.method);
  choice.kappa = given.kappa.value_or(choice.kappa);
  choice.kappa_modulus = given.kappa_modulus.value_or(choice.kappa_modulus);
  choice.precision = given.precision.value_or(choice.precision);
  choice.accuracy = given.accuracy.value_or(choice.accuracy);
  choice.threads = options.threads;
  return choice;
}

/// Throws InputError for options that do not go together.
void require_sensible(const RunOptions& options) {
  require_threads(options.threads);
  if (!(options.checkpoint_every >= 0.0)) {
    throw InputError(
        fmt::format("--checkpoint-every = {} must be in [0, inf) seconds", options.checkpoint_every));
  }
  if (!options.output.empty() && options.output == options.checkpoint) {
    throw InputError(
        fmt::format("--checkpoint = '{}' must be another file than --output", options.checkpoint));
  }
  if (options.sleep && !options.checkpoint.empty()) {
    throw InputError("--sleep: a run of which a part sleeps keeps no checkpoints; leave out --checkpoint");
  }
}

/// Throws InputError for options that are for quasi-static cases only.
void require_quasi_static(const RunOptions& options, const Case& description) {
  if (description.quasi_static) return;
  const auto refuse = [&](const char* option, const char* what) {
    throw InputError(
        fmt::format("{}: '{}' is in motion; {} quasi-static answers", option, description.name, what));
  };
  if (!options.estimate.empty()) refuse("--estimate", "the estimate is for");
  if (options.sleep) refuse("--sleep", "what sleeps is known of");
}

/// What a run has found, static or dynamic.
struct Answer {
  NodalField u;
  std::string status;  ///< "complete", or why not
  long steps = 0;
  double seconds = 0.0;
  double adaption_seconds = 0.0;
};

void print_outcome(const Model& model, const std::string& what) {
  fmt::print("{} {} {}: {}\n", model.scene().description.name, model.choice().method, kappa_text(model),
             what);
}

/// A static answer, of the whole or of what moves.
Relaxation relax_as_requested(const Model& model, const std::optional<double>& sleep, Observer& observer,
                              const Checkpoint* from) {
  if (!sleep) return relax(model, observer, from);
  LocalRelaxation local = relax_awake(model.scene(), model.choice(), *sleep, observer);
  fmt::print("awake: {} of {} elements\n", local.elements, model.scene().mesh.cells.size());
  return std::move(local.relaxation);
}

Answer static_answer(const Model& model, const std::optional<double>& sleep, Observer& observer,
                     const Checkpoint* from) {
  Relaxation found = relax_as_requested(model, sleep, observer, from);
  const Precision precision = model.choice().precision;
  const std::string ending = outcome(found, precision);
  print_outcome(model,
                fmt::format("{} after {} steps, residual {:.2e}", ending, found.steps, found.residual));
  return {std::move(found.u), in_equilibrium(found, precision) ? "complete" : ending, found.steps,
          found.seconds, found.adaption_seconds};
}

Answer dynamic_answer(const Model& model, Observer& observer, const Checkpoint* from) {
  Motion found = integrate(model, observer, from);
  const std::string status =
      found.interrupted ? fmt::format("interrupted at step {}", found.steps) : "complete";
  const std::string subcycles =
      model.scene().description.dynamics.subcycles > 1
          ? fmt::format("{} subcycle{}, ", found.most_substeps, found.most_substeps > 1 ? "s" : "")
          : "";
  print_outcome(model, fmt::format("{} s in {} steps of at least {:.4g} s, {}{}", found.time, found.steps,
                                   found.smallest_step, subcycles, status));
  return {std::move(found.u), status, found.steps, found.seconds, found.adaption_seconds};
}

/// Computes and prints an answer; `writer` and `keeper` may be null.
Answer compute(const RunOptions& options, const Given& given, const Model& model, ResultWriter* writer,
               CheckpointKeeper* keeper) {
  const Scene& scene = model.scene();
  const bool quasi_static = scene.description.quasi_static;
  const Checkpoint* from = keeper != nullptr ? keeper->from() : nullptr;
  if (from != nullptr) fmt::print("goes on from {}\n", options.checkpoint);
  watch_for_interrupt();
  RunObserver observer(scene.description.name, writer, keeper);
  Answer answer = quasi_static ? static_answer(model, given.sleep, observer, from)
                               : dynamic_answer(model, observer, from);
  print_energies(scene, observer.last());
  print_levels(model.choice().method, observer.levels(), answer.adaption_seconds / answer.seconds);
  if (quasi_static && answer.status == "complete") {
    print_accuracy(scene, answer.u);
    print_estimates(options, model, answer.u);
  }
  print_time(answer.seconds, answer.steps, scene.mesh.cells.size(), from != nullptr, given.sleep.has_value());
  return answer;
}

int run_case(const RunOptions& options) {
  const Given given = parse(options);
  require_sensible(options);
  const Scene scene = read_scene(find_case(options.name));
  require_quasi_static(options, scene.description);
  const Model model(scene, choose_method(options, given, scene.description));
  std::optional<CheckpointKeeper> keeper;
  if (!options.checkpoint.empty()) keeper.emplace(model, options.checkpoint, options.checkpoint_every);
  std::optional<ResultWriter> writer;
  if (!options.output.empty()) writer.emplace(model, options.output, provenance(model));
  std::string status;
  try {
    status = compute(options, given, model, writer ? &*writer : nullptr, keeper ? &*keeper : nullptr).status;
  } catch (const ComputationError& error) {
    if (!writer || writer->frames() < 2) throw;
    writer->commit("failed");
    throw ComputationError(fmt::format("{}; what was complete is in {}", error.what(), options.output),
                           error.breakdown());
  }
  if (writer) {
    writer->commit(status);
    fmt::print("wrote {}\n", options.output);
  }
  if (status != "complete") {
    throw ComputationError(fmt::format("{}: {}; what was complete is {}", scene.description.name, status,
                                       writer ? "in " + options.output : "not kept (no --output)"));
  }
  if (keeper) keeper->finish();
  return 0;
}

}  // namespace

void add_run_command(CLI::App& app, int& exit_code) {
  auto options = std::make_shared<RunOptions>();
  CLI::App* command = app.add_subcommand("run", "compute a case with a method");
  command->add_option("CASE", options->name, "name or file of the case");
  command->add_option("-m,--method", options->method,
                      "method, see `sandglass methods`; without it that of the case's [method], else "
                      "tl-perturbation in double with kappa auto");
  command->add_option("-k,--kappa", options->kappa, "strength of the hourglass control, a number or 'auto'");
  command->add_option(
      "--kappa-modulus", options->kappa_modulus,
      "what kappa multiplies: 'p-wave' (lambda + 2 mu, the paper) or 'shear' (mu), whose best "
      "kappa hardly "
      "depends on Poisson's ratio; 'auto' gives the same stiffness with both");
  command->add_option("-p,--precision", options->precision, "numbers to compute in, 'double' or 'float'");
  command->add_option(
      "--accuracy", options->accuracy,
      fmt::format("what an adaptive method aims at, as 0.5% or 0.005: displacement error against its highest "
                  "level over the largest imposed displacement; {:g}% unless told",
                  100.0 * default_accuracy));
  command->add_option(
      "--sleep", options->sleep,
      "leave out what would move by less than this share of the largest imposed displacement, as 0.1%: "
      "elements wake where something moves near them; for quasi-static answers to a local push");
  command->add_option("-t,--threads", options->threads, "threads; the answer does not depend on their number")
      ->capture_default_str();
  command->add_option("-o,--output", options->output,
                      "result file (HDF5; an XDMF file for ParaView goes beside it)");
  command->add_option("--checkpoint", options->checkpoint,
                      "file that keeps the run: killed at any moment, the same command goes on from it and "
                      "ends with the same bits; removed when the run is complete");
  command
      ->add_option("--checkpoint-every", options->checkpoint_every,
                   "seconds between checkpoints; 0 means wherever the run can go on from: at the checks of "
                   "dynamic runs, at the load levels of quasi-static ones")
      ->capture_default_str();
  command
      ->add_option("--estimate", options->estimate,
                   "estimate how far a quasi-static answer is from the 'golden', that of the mean-dilatation "
                   "element on the same mesh, or from the 'truth', that of ever finer meshes; without a word "
                   "the golden")
      ->expected(0, 1)
      ->default_str("golden")
      ->check(CLI::IsMember({"golden", "truth"}));
  command->add_flag("--describe", options->describe,
                    "print every key of a case file with unit, range and meaning");
  command->callback([options, &exit_code] {
    if (options->describe) {
      fmt::print("{}{}", describe_case_keys(), describe_comparison_keys());
      return;
    }
    if (options->name.empty()) throw CLI::RequiredError("CASE");
    exit_code = run_case(*options);
  });
}

}  // namespace sandglass
