#include <fmt/format.h>

#include <memory>

#include "app/commands.hpp"
#include "app/execution_options.hpp"
#include "app/kappa_option.hpp"
#include "app/machine.hpp"
#include "app/progress.hpp"
#include "app/workspace.hpp"
#include "base/error.hpp"
#include "comparison/verdict.hpp"
#include "io/case_file.hpp"
#include "io/result_file.hpp"
#include "stepping/central_difference.hpp"
#include "stepping/relaxation.hpp"

namespace sandglass {

namespace {

struct RunOptions {
  std::string name;
  std::string method = "tl-perturbation";
  std::string kappa = "auto";
  std::string kappa_modulus = "p-wave";
  std::string precision = "double";
  int threads = 1;
  std::string output;
  bool describe = false;
};

/// Writes frames and history to the result file, shows progress, and ends on Ctrl-C.
class RunObserver final : public Observer {
 public:
  RunObserver(const std::string& title, ResultWriter* writer) : progress_(title), writer_(writer) {}

  void frame(const Frame& frame) override {
    if (writer_ != nullptr) writer_->frame(frame);
  }
  void history(const HistoryRow& row) override {
    if (writer_ != nullptr) writer_->history(row);
    last_ = row;
  }
  bool proceed(long step, double share, double residual) override {
    progress_.show(share, fmt::format("step {}, residual {:.1e}", step, residual));
    return !interrupted();
  }
  const HistoryRow& last() const { return last_; }

 private:
  Progress progress_;
  ResultWriter* writer_;
  HistoryRow last_{};
};

std::string kappa_text(const Model& model) {
  const auto& choice = model.choice();
  if (!takes_kappa(choice.method)) return "";
  const auto automatic = auto_kappa(choice.method, model.scene().description.law, choice.kappa_modulus);
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
  const auto print = [&](const char* name, const std::optional<NodalField>& reference) {
    const auto figures = accuracy_of(scene, u, reference);
    if (!figures) return;
    fmt::print("against the {}: max {:.4g} %, rms {:.4g} % of the imposed displacement\n", name,
               100.0 * figures->max_relative_error, 100.0 * figures->rms_relative_error);
  };
  print("golden", references.golden);
  print("truth", references.truth);
}

int run_case(const RunOptions& options) {
  const Precision precision = parse_precision(options.precision);
  require_threads(options.threads);
  const Scene scene = read_scene(find_case(options.name));
  const Model model(scene, {.method = options.method,
                            .kappa = parse_kappa(options.kappa),
                            .precision = precision,
                            .threads = options.threads,
                            .kappa_modulus = parse_kappa_modulus(options.kappa_modulus)});
  std::optional<ResultWriter> writer;
  if (!options.output.empty()) writer.emplace(model, options.output, provenance(model));
  std::string status;
  long steps = 0;
  double seconds = 0.0;
  watch_for_interrupt();
  {
    RunObserver observer(scene.description.name, writer ? &*writer : nullptr);
    NodalField u;
    if (scene.description.quasi_static) {
      Relaxation relaxation = relax(model, observer);
      u = std::move(relaxation.u);
      steps = relaxation.steps;
      seconds = relaxation.seconds;
      const std::string ending = outcome(relaxation, model.choice().precision);
      status = at_rest(relaxation, model.choice().precision) ? "complete" : ending;
      fmt::print("{} {} {}: {} after {} steps, residual {:.2e}\n", scene.description.name, options.method,
                 kappa_text(model), ending, steps, relaxation.residual);
    } else {
      Motion motion = integrate(model, observer);
      u = std::move(motion.u);
      steps = motion.steps;
      seconds = motion.seconds;
      status = motion.interrupted ? fmt::format("interrupted at step {}", steps) : "complete";
      fmt::print("{} {} {}: {} s in {} steps of at least {:.4g} s, {}\n", scene.description.name,
                 options.method, kappa_text(model), motion.time, steps, motion.smallest_step, status);
    }
    print_energies(scene, observer.last());
    if (scene.description.quasi_static && status == "complete") print_accuracy(scene, u);
  }
  fmt::print("wall time {:.3g} s, {:.4g} ns per element and step\n", seconds,
             1e9 * seconds / static_cast<double>(std::max(steps, 1L)) /
                 static_cast<double>(scene.mesh.cells.size()));
  if (writer) {
    writer->commit(status);
    fmt::print("wrote {}\n", options.output);
  }
  if (status != "complete") {
    throw ComputationError(fmt::format("{}: {}; what was complete is {}", scene.description.name, status,
                                       writer ? "in " + options.output : "not kept (no --output)"));
  }
  return 0;
}

}  // namespace

void add_run_command(CLI::App& app, int& exit_code) {
  auto options = std::make_shared<RunOptions>();
  CLI::App* command = app.add_subcommand("run", "compute a case with a method");
  command->add_option("CASE", options->name, "name or file of the case");
  command->add_option("-m,--method", options->method, "method, see `sandglass methods`")
      ->capture_default_str();
  command->add_option("-k,--kappa", options->kappa, "strength of the hourglass control, a number or 'auto'")
      ->capture_default_str();
  command
      ->add_option("--kappa-modulus", options->kappa_modulus,
                   "what kappa multiplies: 'p-wave' (lambda + 2 mu, the paper) or 'shear' (mu), whose best "
                   "kappa hardly "
                   "depends on Poisson's ratio; 'auto' gives the same stiffness with both")
      ->capture_default_str();
  command->add_option("-p,--precision", options->precision, "numbers to compute in, 'double' or 'float'")
      ->capture_default_str();
  command->add_option("-t,--threads", options->threads, "threads; the answer does not depend on their number")
      ->capture_default_str();
  command->add_option("-o,--output", options->output,
                      "result file (HDF5; an XDMF file for ParaView goes beside it)");
  command->add_flag("--describe", options->describe,
                    "print every key of a case file with unit, range and meaning");
  command->callback([options, &exit_code] {
    if (options->describe) {
      fmt::print("{}", describe_case_keys());
      return;
    }
    if (options->name.empty()) throw CLI::RequiredError("CASE");
    exit_code = run_case(*options);
  });
}

}  // namespace sandglass
