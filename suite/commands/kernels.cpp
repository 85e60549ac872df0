#include "commands/kernels.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "assembly/method_entry.hpp"
#include "base/error.hpp"
#include "base/names.hpp"
#include "commands/execution_options.hpp"
#include "io/case_file.hpp"
#include "problem/make_scene.hpp"
#include "written/kernel_text.hpp"
#include "written/mesh_constants.hpp"
#include "written/node_kernels.hpp"

namespace sandglass {

namespace {

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
const CaseMaterial& material_of(const Case& description, std::optional<int> chosen) {
  const int count = static_cast<int>(description.materials.size());
  if (count > 1 && !chosen) {
    throw InputError(fmt::format("case '{}' has {} materials; choose one with --material, from 1 to {}",
                                 description.name, count, count));
  }
  const int number = chosen.value_or(1);
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

/// Throws InputError for a method without such a kernel.
void require_written(const std::string& method) {
  method_named(method, "METHOD");
  if (const auto reason = why_not_written(method); !reason.empty()) {
    throw InputError(fmt::format("METHOD = '{}' has no kernel that could be written: {}", method, reason));
  }
}

}  // namespace

std::string kernel_source(const KernelRequest& request, const Case& description,
                          const Provenance& provenance) {
  require_written(request.method);
  const Dialect& dialect = dialect_named(request.dialect);
  const auto of = [&](std::string_view name) {
    const auto found = std::ranges::find(provenance, name, &Provenance::value_type::first);
    return found == provenance.end() ? std::string() : found->second;
  };
  const bool single = precision_in(dialect, request.precision) == Precision::single_precision;
  const CaseMaterial& material = material_of(description, request.material);
  if (is_viscoelastic(material.law)) {
    throw InputError(
        fmt::format("case '{}': law '{}' remembers earlier steps; kernels are written for elastic laws",
                    description.name, name_of(material.law)));
  }
  const ForceProgram force =
      force_program(request.method, elastic_law(kernel_law(material)), has_fibres(material.law));
  if (!dialect.keeps_sums && needs_order_of_sums(force.program)) {
    throw InputError(
        fmt::format("--dialect = '{}': the exponentials or logarithms of law '{}' lose digits in {}, whose "
                    "compilers may reorder "
                    "sums; allowed: laws without them, or another dialect",
                    dialect.name, name_of(material.law), dialect.language));
  }
  KernelTitle title{request.method + "_force",
                    {fmt::format("Internal forces of elements of {} with the law {}, in {}.", request.method,
                                 law_text(material), single ? "float" : "double"),
                     fmt::format("{}, written by `sandglass kernels` of sandglass {} ({}).", dialect.language,
                                 of("version"), of("revision"))}};
  std::replace(title.name.begin(), title.name.end(), '-', '_');
  const auto written = [&]<class Real>(Real) {
    if (!request.step) return kernel_text<Real>(force, dialect, title);
    return kernel_text<Real>(force, dialect, title, NodalValues::of_nodes) + "\n" +
           node_kernels_text<Real>(dialect);
  };
  return single ? written(0.0F) : written(0.0);
}

std::string kernel_constants(const KernelRequest& request, const Case& description) {
  require_written(request.method);
  const Precision precision = precision_in(dialect_named(request.dialect), request.precision);
  material_of(description, request.material);
  const Scene scene = make_scene(with_mesh(description));
  const MethodChoice choice = method_of(scene.settings, request.method);
  std::vector<std::vector<double>> of_elements;
  for (std::size_t e = 0; e < scene.mesh.cells.size(); ++e) {
    if (scene.materials.of(e) + 1 != static_cast<std::size_t>(request.material.value_or(1))) continue;
    of_elements.push_back(constants_of(scene.mesh, scene.materials, choice, e));
  }
  const auto bytes = [&]<class Real>(Real) {
    std::vector<Real> numbers;
    for (std::size_t k = 0; k < of_elements.front().size(); ++k)
      for (const auto& own : of_elements) numbers.push_back(static_cast<Real>(own[k]));
    return std::string(reinterpret_cast<const char*>(numbers.data()), numbers.size() * sizeof(Real));
  };
  return precision == Precision::single_precision ? bytes(0.0F) : bytes(0.0);
}

}  // namespace sandglass
