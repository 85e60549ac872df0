#include "app/run_options.hpp"

#include <fmt/format.h>

#include "assembly/method_entry.hpp"
#include "base/error.hpp"
#include "commands/execution_options.hpp"
#include "commands/kappa_option.hpp"
#include "comparison/verdict.hpp"
#include "device/opencl_processor.hpp"
#include "forces/contact_force.hpp"
#include "io/case_file.hpp"
#include "io/new_file.hpp"
#include "io/result_file.hpp"

namespace sandglass {

Given parse(const RunOptions& options) {
  Given given;
  if (options.precision) given.precision = parse_precision(*options.precision);
  if (options.kappa) given.kappa = parse_kappa(*options.kappa);
  if (options.kappa_modulus) given.kappa_modulus = parse_kappa_modulus(*options.kappa_modulus);
  if (options.accuracy) given.accuracy = parse_share("--accuracy", *options.accuracy);
  if (options.sleep) given.sleep = parse_share("--sleep", *options.sleep);
  return given;
}

MethodChoice choose_method(const RunOptions& options, const Given& given, const CaseSettings& settings) {
  MethodChoice choice = method_of(settings, options.method);
  // The mesh is refined for this method, which also computes the answer by default.
  if (!options.against.empty() && !options.method && !settings.method) choice.method = golden_method;
  choice.kappa = given.kappa.value_or(choice.kappa);
  choice.kappa_modulus = given.kappa_modulus.value_or(choice.kappa_modulus);
  choice.precision = given.precision.value_or(choice.precision);
  choice.accuracy = given.accuracy.value_or(choice.accuracy);
  if (given.accuracy && options.against.empty() && !method_named(choice.method).adapts()) {
    throw InputError(
        fmt::format("--accuracy: '{}' does not adapt; allowed: an adaptive method, such as tl-adaptive, "
                    "or --against truth, which refines the mesh",
                    choice.method));
  }
  choice.threads = options.threads;
  choice.ranks = options.ranks;
  choice.processor = processor_named(options.device);
  return choice;
}

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
  if (!options.against.empty()) {
    if (!options.accuracy)
      throw InputError("--against: needs --accuracy, the largest allowed error, such as --accuracy 2%");
    if (options.sleep)
      throw InputError("--against: a refined mesh is computed as a whole; leave out --sleep");
    if (!options.checkpoint.empty())
      throw InputError(
          "--against: a run that refines its mesh writes no checkpoints; leave out --checkpoint");
  }
  if (options.ranks->count() > 1 &&
      (options.sleep || !options.against.empty() || options.estimate == "truth")) {
    throw InputError(
        "--sleep, --against and --estimate truth compute parts or other meshes, which are not divided among "
        "ranks; allowed: one rank with more --threads");
  }
  if (options.sleep && !options.checkpoint.empty()) {
    throw InputError("--sleep: such a run writes no checkpoints; leave out --checkpoint");
  }
}

void require_supported(const RunOptions& options, const Scene& scene) {
  const CaseSettings& settings = scene.settings;
  const auto refuse = [&](const char* option, const std::string& why) {
    throw InputError(fmt::format("{}: {}", option, why));
  };
  const auto refuse_motion = [&](const char* option, const char* what) {
    refuse(option, fmt::format("'{}' is a dynamic case; {} quasi-static cases", settings.name, what));
  };
  if (!settings.quasi_static) {
    if (!options.estimate.empty()) refuse_motion("--estimate", "errors are estimated for");
    if (!options.against.empty()) refuse_motion("--against", "meshes are refined for");
    if (options.sleep) refuse_motion("--sleep", "elements sleep in");
  }
  if (!options.estimate.empty() && remember_path(scene.forces)) {
    refuse("--estimate", "friction depends on the path; allowed: cases without friction");
  }
  const bool refines = options.estimate == "truth" || !options.against.empty();
  if (refines && movable_of(scene.forces).size() < contacts_of(scene.forces).size()) {
    refuse(
        options.against.empty() ? "--estimate truth" : "--against truth",
        "a refined mesh does not inherit the touching points of a [[contact]]; allowed: cases without one");
  }
}

void require_places(const RunOptions& options, const CaseSettings& settings) {
  const auto& inputs = settings.files;
  if (!options.checkpoint.empty()) require_place(options.checkpoint, inputs);
  if (options.output.empty()) return;
  const std::filesystem::path output(options.output);
  if (output.extension() != ".h5") {
    throw InputError(fmt::format(
        "--output = '{}' must end in .h5; an .xdmf of the same name is written beside it", options.output));
  }
  require_place(output, inputs);
  require_place(guide_of(output), inputs);
}

}  // namespace sandglass
