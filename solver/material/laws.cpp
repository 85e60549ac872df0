#include "material/laws.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "base/error.hpp"

namespace sandglass {

namespace {

template <class Law>
KernelLaw to_kernel_law(const Law& law, VolumetricPart volume) {
  return CalledLaw(law, volume);
}
KernelLaw to_kernel_law(const NeoHookean& law, VolumetricPart volume) {
  if (std::holds_alternative<QuadraticPart>(volume)) return law;
  return CalledLaw(law, volume);
}
template <class Law>
KernelLaw to_kernel_law(const Viscoelastic<Law>& law, VolumetricPart volume) {
  return Viscoelastic<CalledLaw>{CalledLaw(static_cast<const Law&>(law), volume), law.relaxation_1,
                                 law.time_1, law.relaxation_2, law.time_2};
}

}  // namespace

KernelLaw kernel_law(const AnyLaw& any_law, VolumetricPart volume) {
  return std::visit([=](const auto& law) { return to_kernel_law(law, volume); }, any_law);
}

std::vector<std::string_view> parameter_names(const AnyLaw& law) {
  std::vector<std::string_view> names;
  AnyLaw copy = law;
  for_each_parameter(copy, [&](const auto& parameter, double) { names.push_back(parameter.name); });
  return names;
}

void require_parameter(const AnyLaw& law, std::string_view name, std::string_view where) {
  const auto names = parameter_names(law);
  if (std::ranges::find(names, name) != names.end()) return;
  throw InputError(fmt::format("{}: '{}' is not a parameter of '{}'; allowed: {}", where, name, name_of(law),
                               fmt::join(names, ", ")));
}

AnyLaw with_parameters(AnyLaw law, const std::map<std::string, double>& values, std::string_view where) {
  for_each_parameter(law, [&](const auto& parameter, double& value) {
    const auto given = values.find(std::string(parameter.name));
    if (given == values.end()) return;
    value = given->second;
    if (parameter.range.contains(value)) return;
    throw InputError(
        fmt::format("{}: {} = {} must be in {}", where, parameter.name, value, parameter.range.text()));
  });
  for (const auto& [name, value] : values) require_parameter(law, name, where);
  std::visit(
      [&]<class Law>(const Law& own) {
        if constexpr (requires { own.broken_rule(); }) {
          if (const auto broken = own.broken_rule())
            throw InputError(fmt::format("{}: {} {}", where, broken->parameter, broken->message));
        }
      },
      law);
  return law;
}

CalledLaw elastic_law(const KernelLaw& kernel_law) {
  if (const auto* law = std::get_if<NeoHookean>(&kernel_law)) return CalledLaw(*law);
  if (const auto* law = std::get_if<CalledLaw>(&kernel_law)) return *law;
  return static_cast<const CalledLaw&>(std::get<Viscoelastic<CalledLaw>>(kernel_law));
}

}  // namespace sandglass
