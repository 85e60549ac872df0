#include <fmt/format.h>

#include <cstdio>
#include <memory>

#include "app/case_keys.hpp"
#include "app/checkpoint_keeper.hpp"
#include "app/commands.hpp"
#include "app/machine.hpp"
#include "app/mpi_ranks.hpp"
#include "app/run_observer.hpp"
#include "app/run_options.hpp"
#include "app/run_report.hpp"
#include "app/scene_report.hpp"
#include "assembly/method_entry.hpp"
#include "base/error.hpp"
#include "base/memory.hpp"
#include "commands/execution_options.hpp"
#include "commands/workspace.hpp"
#include "comparison/comparison.hpp"
#include "comparison/truth_estimate.hpp"
#include "comparison/verdict.hpp"
#include "io/case_file.hpp"
#include "io/result_file.hpp"
#include "problem/held.hpp"
#include "solve/central_difference.hpp"
#include "solve/error_estimate.hpp"
#include "solve/leapfrog.hpp"
#include "solve/relaxation.hpp"
#include "solve/sleep.hpp"

namespace sandglass {

namespace {

Provenance provenance(const Model& model) {
  Provenance attributes = build_provenance();
  attributes.insert(attributes.end(), {{"method", model.choice().method},
                                       {"kappa", kappa_text(model)},
                                       {"precision", std::string(name_of(model.choice().precision))}});
  return attributes;
}

/// Prints the requested error estimate: against the golden's element on the same mesh, or against the truth.
void print_estimate_of(const std::string& against, const CaseOnMesh& problem, const Model& model,
                       const NodalField& u) {
  const double unit = displacement_unit(model.scene(), u);
  const auto print = [&](std::string_view what, double largest, double rms, const std::string& how) {
    print_estimate(what, model.scene(), unit, largest, rms, how);
  };
  if (against == "golden") {
    const ErrorEstimate estimate = estimate_error(model, u);
    print(golden_method, estimate.largest, estimate.rms,
          fmt::format("after {} evaluations", estimate.evaluations));
  } else if (against == "truth") {
    const TruthEstimate estimate = estimate_truth_error(problem, model.choice().threads, u);
    print("the truth", estimate.largest, estimate.rms,
          fmt::format("from meshes of up to {} elements", estimate.elements));
    if (!estimate.remark.empty()) fmt::print("note: refined once instead of twice: {}\n", estimate.remark);
  }
}

/// The answer of a run, static or dynamic.
struct RunAnswer {
  NodalField u;
  std::string status;          ///< "complete", or the reason why not
  std::string stability = {};  ///< of a static answer; see stability_text
  double seconds = 0.0;
  double adaption_seconds = 0.0;
  bool near_enough = true;  ///< to the exact answer, if an accuracy was requested
};

/// A mesh that was refined for an accuracy, and the case's own scene, on which it is compared.
struct Refined {
  const Scene& own;  ///< of the case
  AccurateMesh mesh;
  double accuracy;
};

/// The refined mesh of a run with --against truth, else none.
std::optional<Refined> refine_as_requested(const RunOptions& options, const Given& given,
                                           const CaseOnMesh& problem, const Scene& scene) {
  if (options.against.empty()) return std::nullopt;
  return Refined{scene, refine_until_within(*given.accuracy, problem, options.threads), *given.accuracy};
}

/// Prints how far an answer u (m) on a refined mesh is from the exact one. Returns whether it is near enough.
bool print_refined(const Refined& refined, const std::string& method, NodalField u) {
  const auto& [own, mesh, accuracy] = refined;
  const double largest = largest_distance(mesh.limit, u), unit = displacement_unit(own, mesh.limit);
  print_estimate("the truth", own, unit, largest, rms_distance(mesh.limit, u),
                 fmt::format("on {} elements instead of {}, found in {:.3g} s", mesh.scene.mesh.cells.size(),
                             own.mesh.cells.size(), mesh.seconds));
  u.resize(own.mesh.points.size());
  print_accuracy(own, u, false);
  if (largest <= accuracy * unit) return true;
  fmt::print("note: that is more than {:.3g} %: the mesh is fine enough for {}, but not for {}\n",
             100.0 * accuracy, golden_method, method);
  return false;
}

/// A static answer of the whole body, or of its awake part.
Relaxation relax_as_requested(const Model& model, const std::optional<double>& sleep, Observer& observer,
                              const Checkpoint* from, const NodalField* near) {
  if (!sleep) return relax(model, observer, from, near);
  LocalRelaxation local = relax_awake(model.scene(), model.choice(), *sleep, observer);
  fmt::print("awake: {} of {} elements\n", local.elements, model.scene().mesh.cells.size());
  return std::move(local.relaxation);
}

RunAnswer static_answer(const Model& model, const std::optional<double>& sleep, RunObserver& observer,
                        const Checkpoint* from, const NodalField* near) {
  Relaxation found = relax_as_requested(model, sleep, observer, from, near);
  observer.end();
  const Precision precision = model.choice().precision;
  print_static_ending(found, precision, model.scene().settings.relaxation.tolerance, from != nullptr);
  const bool rests = in_equilibrium(found);
  return {.u = std::move(found.u),
          .status = rests ? "complete" : outcome(found, precision),
          .stability = rests ? stability_text(found) : "",
          .seconds = found.seconds,
          .adaption_seconds = found.adaption_seconds};
}

RunAnswer dynamic_answer(const Model& model, RunObserver& observer, const Checkpoint* from) {
  Motion found = integrate(model, observer, from);
  observer.end();
  print_dynamic_ending(found, model, from != nullptr);
  return {.u = std::move(found.u),
          .status = found.interrupted ? fmt::format("interrupted at step {}", found.steps) : "complete",
          .seconds = found.seconds,
          .adaption_seconds = found.adaption_seconds};
}

/// Computes and prints an answer; `refined`, `writer` and `keeper` may be null.
RunAnswer compute(const RunOptions& options, const Given& given, const CaseOnMesh& problem,
                  const Model& model, const Refined* refined, ResultWriter* writer,
                  CheckpointKeeper* keeper) {
  const Scene& scene = model.scene();
  const bool quasi_static = scene.settings.quasi_static;
  const Checkpoint* from = keeper != nullptr ? keeper->from() : nullptr;
  if (from != nullptr) fmt::print("resumed from {}\n", options.checkpoint);
  RunObserver observer(model, writer, keeper);
  const NodalField* near = refined != nullptr ? &refined->mesh.u : nullptr;
  RunAnswer answer = quasi_static ? static_answer(model, given.sleep, observer, from, near)
                                  : dynamic_answer(model, observer, from);
  print_answer(model, answer.u, observer.volume_ratios(), observer.found());
  print_levels(model.choice().method, observer.levels(), answer.adaption_seconds / answer.seconds);
  if (quasi_static && answer.status == "complete") {
    if (refined != nullptr) {
      answer.near_enough = print_refined(*refined, model.choice().method, answer.u);
    } else {
      print_accuracy(scene, answer.u, true);
    }
    print_estimate_of(options.estimate, problem, model, answer.u);
  }
  if (options.ranks->count() > 1) print_traffic(*options.ranks);
  if (options.ranks->rank() == 0) warn_of_suspect(model, observer.found());
  return answer;
}

int run_case(const RunOptions& options) {
  const Given given = parse(options);
  require_sensible(options);
  warn_if_bound(*options.ranks, options.threads);
  const CaseOnMesh problem = with_mesh(find_case(options.name));
  const Scene scene = make_scene(problem);
  require_supported(options, scene);
  require_places(options, scene.settings);
  if (!options.sleep) {  // --sleep computes a part
    require_memory(static_cast<double>(scene.mesh.cells.size()),
                   scene.settings.quasi_static ? MeshUse::equilibrium : MeshUse::motion);
  }
  const MethodChoice choice = choose_method(options, given, scene.settings);
  const Model own(scene, choice);
  if (scene.settings.quasi_static) {
    require_held(scene);
  } else {
    require_steps(own);
  }
  print_problem(scene);  // the input has been checked by now
  if (options.ranks->rank() == 0) print_understood(problem, scene);
  const auto refined = refine_as_requested(options, given, problem, scene);
  std::optional<Model> on_refined;
  if (refined) on_refined.emplace(refined->mesh.scene, choice);
  const Model& model = on_refined ? *on_refined : own;
  watch_for_interrupt();  // before there are files that could be left behind
  std::optional<CheckpointKeeper> keeper;
  if (!options.checkpoint.empty()) keeper.emplace(model, options.checkpoint, options.checkpoint_every);
  std::optional<ResultWriter> writer;
  if (!options.output.empty()) writer.emplace(model, options.output, provenance(model));
  print_method(model);
  std::fflush(stdout);  // visible while it computes
  RunAnswer answer;
  try {
    answer = compute(options, given, refined ? refined->mesh.problem : problem, model,
                     refined ? &*refined : nullptr, writer ? &*writer : nullptr, keeper ? &*keeper : nullptr);
  } catch (const ComputationError& error) {
    if (!writer || writer->frames() < 2) throw;
    writer->commit("failed");
    throw ComputationError(fmt::format("{}; results so far are in {}", error.what(), options.output),
                           error.breakdown());
  }
  if (writer) {
    if (!answer.stability.empty()) writer->note("stability", answer.stability);
    writer->commit(answer.status);
    fmt::print("wrote {}; open {} in ParaView\n", options.output, guide_of(options.output).string());
  } else if (answer.status == "complete") {
    fmt::print("nothing stored; -o FILE.h5 stores displacements, stresses, reactions and energies\n");
  }
  if (answer.status != "complete") {
    throw ComputationError(fmt::format("{}: {}; results so far are {}", scene.settings.name, answer.status,
                                       writer ? "in " + options.output : "not stored (no --output)"));
  }
  if (keeper) keeper->finish();
  return answer.near_enough ? 0 : 1;
}

}  // namespace

void add_run_command(CLI::App& app, int& exit_code, std::shared_ptr<const Ranks> ranks) {
  auto options = std::make_shared<RunOptions>();
  options->ranks = std::move(ranks);
  CLI::App* command = app.add_subcommand("run", "compute a case with a method");
  command->add_option("CASE", options->name, "name or file of the case");
  command
      ->add_option("-m,--method", options->method,
                   "method, see `sandglass methods`; default: the case's [method], else "
                   "tl-perturbation in double with kappa auto, or tl-mean-dilatation with --against")
      ->type_name("METHOD");
  command->add_option("-k,--kappa", options->kappa, "strength of the hourglass control, a number or 'auto'");
  command->add_option(
      "--kappa-modulus", options->kappa_modulus,
      "the modulus that kappa multiplies: 'p-wave' (lambda + 2 mu, the paper) or 'shear' (mu), for which the "
      "best kappa hardly depends on Poisson's ratio; 'auto' gives the same stiffness with both");
  command->add_option("-p,--precision", options->precision, "numbers to compute in, 'double' or 'float'");
  command->add_option(
      "--accuracy", options->accuracy,
      fmt::format("target of an adaptive method, such as 0.5% or 0.005: displacement error against its "
                  "highest level over the largest imposed displacement; default: {:g}%",
                  100.0 * default_accuracy));
  command
      ->add_option(
          "--against", options->against,
          "with 'truth', --accuracy is the largest distance from the exact answer at any node of the case's "
          "mesh, over the largest imposed displacement: the mesh is refined where the "
          "mean-dilatation element errs, until the estimated error is within this limit. Exit code "
          "1 if that element is accurate enough but METHOD is not")
      ->check(CLI::IsMember({"truth"}));
  command->add_option(
      "--sleep", options->sleep,
      "leave out elements that would move by less than this share of the largest imposed displacement, such "
      "as 0.1%; elements wake when others move near them; for quasi-static cases with a local load");
  command->add_option("-t,--threads", options->threads, "threads; the answer does not depend on their number")
      ->capture_default_str();
  add_device_option(*command, options->device);
  command->add_option("-o,--output", options->output,
                      "result file (HDF5; an XDMF file for ParaView is written beside it)");
  command->add_option("--checkpoint", options->checkpoint,
                      "checkpoint file: if the run is killed, the same command resumes it from there and "
                      "ends with the same bits; removed when the run is complete");
  command
      ->add_option("--checkpoint-every", options->checkpoint_every,
                   "seconds between checkpoints; 0: as often as possible, at every check of a dynamic run "
                   "and every load level of a quasi-static one")
      ->capture_default_str();
  command
      ->add_option("--estimate", options->estimate,
                   "estimate how far a quasi-static answer is from the 'golden' (the mean-dilatation element "
                   "on the same mesh), or from the 'truth' (ever finer meshes); golden if no value is given")
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
