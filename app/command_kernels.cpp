#include <fmt/format.h>

#include <memory>

#include "app/commands.hpp"
#include "app/machine.hpp"
#include "commands/kernels.hpp"
#include "commands/workspace.hpp"
#include "io/new_file.hpp"
#include "io/text_file.hpp"
#include "written/dialects.hpp"

namespace sandglass {

namespace {

struct KernelOptions {
  KernelRequest request;
  std::string case_name;
  std::string output;
  std::string constants;
};

void write_kernels(const KernelOptions& options) {
  const Case description = find_case(options.case_name);
  require_places({options.output, options.constants}, description.files);
  const std::string text = kernel_source(options.request, description, build_provenance());
  if (options.output.empty()) {
    fmt::print("{}", text);
  } else {
    write_text_file(options.output, text);
  }
  if (!options.constants.empty())
    write_text_file(options.constants, kernel_constants(options.request, description));
}

}  // namespace

void add_kernels_command(CLI::App& app) {
  auto options = std::make_shared<KernelOptions>();
  std::vector<std::string> names;
  for (const Dialect& dialect : dialects()) names.emplace_back(dialect.name);
  CLI::App* command = app.add_subcommand(
      "kernels",
      "write the force of a method's elements as source code for other processors.\n"
      "The text is straight-line code, recorded from the program's own kernel, for an elastic law of a "
      "case;\n"
      "a comment describes its arrays. Without contraction into fused operations its results equal the\n"
      "kernel's on plain numbers, bit by bit");
  command->add_option("METHOD", options->request.method, "see `sandglass methods`")->required();
  command->add_option("CASE", options->case_name, "name or file of the case with the material")->required();
  command->add_option("--dialect", options->request.dialect, "the language")
      ->check(CLI::IsMember(names))
      ->capture_default_str();
  command->add_option("-p,--precision", options->request.precision,
                      "double or float; default: double if the dialect has it");
  command->add_option("--material", options->request.material,
                      "number of the material, from 1, if the case has several");
  command->add_flag(
      "--step", options->request.step,
      "add the kernels of nodes, which take time steps; the force then reads nodes by their places");
  command->add_option("--constants", options->constants,
                      "also write the array `constants` for the elements of the case's mesh to this file");
  command->add_option("-o,--output", options->output, "write to this file instead of printing");
  command->callback([options] { write_kernels(*options); });
}

}  // namespace sandglass
