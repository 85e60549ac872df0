#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <memory>

#include "app/build_info.hpp"
#include "app/commands.hpp"
#include "app/execution_options.hpp"
#include "app/workspace.hpp"
#include "assembly/method_entry.hpp"
#include "io/new_file.hpp"
#include "io/text_file.hpp"
#include "written/kernel_text.hpp"

namespace sandglass {

namespace {

struct KernelOptions {
  std::string method;
  std::string case_name;
  std::string dialect = "c";
  std::string precision;
  std::string output;
  int material = 1;
};

/// The precision as chosen, or the dialect's widest.
Precision precision_in(const Dialect& dialect, const std::string& chosen) {
  const bool has_double = !dialect.bits_of_double.empty();
  if (chosen.empty()) return has_double ? Precision::double_precision : Precision::single_precision;
  const Precision precision = parse_precision(chosen);
  if (precision == Precision::double_precision && !has_double) {
    throw InputError(
        fmt::format("--precision = 'double' must be 'float': {} has no double precision", dialect.language));
  }
  return precision;
}

/// The only material of a case, or the one chosen.
const CaseMaterial& material_of(const Case& description, int number, bool chosen) {
  const int count = static_cast<int>(description.materials.size());
  if (count > 1 && !chosen) {
    throw InputError(fmt::format("case '{}' has {} materials; choose one with --material, from 1 to {}",
                                 description.name, count, count));
  }
  require_count("--material", number, count);
  return description.materials[static_cast<std::size_t>(number - 1)];
}

/// "yeoh (c1 = 500 Pa, ...)".
std::string law_text(const Material& material) {
  std::vector<std::string> values;
  std::visit(
      [&]<class Law>(const Law& law) {
        std::apply(
            [&](const auto&... p) {
              (values.push_back(fmt::format("{} = {}{}{}", p.name, law.*p.member, p.unit == "-" ? "" : " ",
                                            p.unit == "-" ? "" : p.unit)),
               ...);
            },
            Law::parameters());
      },
      material.law);
  const auto volume =
      std::visit([]<class Part>(const Part&) { return std::string(Part::name); }, material.volume);
  return fmt::format("{} ({}), volumetric part {}", name_of(material.law), fmt::join(values, ", "), volume);
}

/// Whether it computes exponentials or logarithms, which add and subtract large numbers to round.
bool needs_order_of_sums(const Program& program) {
  return std::ranges::any_of(program.steps, [](const Step& step) {
    return step.operation == Operation::expm1 || step.operation == Operation::log1p;
  });
}

void write_kernels(const KernelOptions& options, bool material_chosen) {
  method_named(options.method, "METHOD");
  if (const auto reason = why_not_written(options.method); !reason.empty()) {
    throw InputError(
        fmt::format("METHOD = '{}' has no kernel that could be written: {}", options.method, reason));
  }
  const Dialect& dialect = dialect_named(options.dialect);
  const bool single = precision_in(dialect, options.precision) == Precision::single_precision;
  const Case description = find_case(options.case_name);
  if (!options.output.empty()) require_place(options.output, description.files);
  const CaseMaterial& material = material_of(description, options.material, material_chosen);
  if (is_viscoelastic(material.law)) {
    throw InputError(
        fmt::format("case '{}': law '{}' remembers earlier steps; kernels are written for elastic laws",
                    description.name, name_of(material.law)));
  }
  const ForceProgram force =
      force_program(options.method, elastic_law(kernel_law(material)), has_fibres(material.law));
  if (!dialect.keeps_sums && needs_order_of_sums(force.program)) {
    throw InputError(
        fmt::format("--dialect = '{}': the exponentials or logarithms of law '{}' lose digits in {}, whose "
                    "compilers may reorder "
                    "sums; allowed: laws without them, or another dialect",
                    dialect.name, name_of(material.law), dialect.language));
  }
  KernelTitle title{options.method + "_force",
                    {fmt::format("Internal forces of elements of {} with the law {}, in {}.", options.method,
                                 law_text(material), single ? "float" : "double"),
                     fmt::format("{}, written by `sandglass kernels` of sandglass {} ({}).", dialect.language,
                                 build_info::version, build_info::revision)}};
  std::replace(title.name.begin(), title.name.end(), '-', '_');
  const std::string text =
      single ? kernel_text<float>(force, dialect, title) : kernel_text<double>(force, dialect, title);
  if (options.output.empty()) {
    fmt::print("{}", text);
  } else {
    write_text_file(options.output, text);
  }
}

}  // namespace

void add_kernels_command(CLI::App& app) {
  auto options = std::make_shared<KernelOptions>();
  std::vector<std::string> names;
  for (const Dialect& dialect : dialects()) names.emplace_back(dialect.name);
  CLI::App* command = app.add_subcommand(
      "kernels",
      "write the force of a method's elements as source for other processors.\n"
      "The kernel is straight-line code, recorded from the one that runs here, for an elastic law of a case; "
      "a\n"
      "comment in the text describes its arrays. Without contraction into fused operations its results are\n"
      "those of the kernel on plain numbers, bit by bit");
  command->add_option("METHOD", options->method, "see `sandglass methods`")->required();
  command->add_option("CASE", options->case_name, "name or file of the case whose material it is for")
      ->required();
  command->add_option("--dialect", options->dialect, "the language")
      ->check(CLI::IsMember(names))
      ->capture_default_str();
  command->add_option("-p,--precision", options->precision,
                      "double or float; default: double where the dialect has it");
  auto* material = command->add_option("--material", options->material,
                                       "number of the material, from 1, if the case has several");
  command->add_option("-o,--output", options->output, "write to this file instead of printing");
  command->callback([options, material] { write_kernels(*options, material->count() > 0); });
}

}  // namespace sandglass
