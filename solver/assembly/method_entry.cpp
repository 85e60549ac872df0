#include "assembly/method_entry.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "base/error.hpp"
#include "base/names.hpp"
#include "element/methods.hpp"

namespace sandglass {

namespace {

template <class Method, class Number>
Kernels<Number> packed_kernels() {
  Kernels<Number> own = kernels<Method, Number>();
  own.assemble_batch = batch_kernels<Number>(Method::name);
  return own;
}

template <class Method>
MethodEntry entry_of() {
  using Hourglass = typename Method::Hourglass;
  using Owner = KernelOwner<Method>;
  return {.name = Method::name,
          .summary = Method::summary,
          .integration_points = integration_points<Method>,
          .controls_hourglass = integration_points<Method> > 1 || Hourglass::traits.active,
          .damps_only = DampsOnly<Hourglass>,
          .takes_kappa = Hourglass::traits.takes_kappa,
          .kappa_affects_equilibrium = kappa_affects_equilibrium<Method>,
          .pressure_varies = pressure_varies<Method>,
          .is_linear = is_linear<Method>,
          .is_condensed = is_condensed<Method>,
          .knows_viscoelasticity = knows_law<Method, Viscoelastic<CalledLaw>>,
          .levels = level_names<Method>(),
          .packed_double = packed_kernels<Owner, Pack<double>>(),
          .packed_float = packed_kernels<Owner, Pack<float>>(),
          .scalar_double = &scalar_kernels<Owner>,
          .auto_kappa = [](const CalledLaw& law, KappaModulus modulus) -> std::optional<double> {
            if constexpr (Hourglass::traits.takes_kappa) return Hourglass::auto_kappa(law, modulus);
            return std::nullopt;
          }};
}

}  // namespace

const std::vector<MethodEntry>& methods() {
  static const std::vector<MethodEntry> entries = []<class... Method>(TypeList<Method...>) {
    return std::vector<MethodEntry>{entry_of<Method>()...};
  }(Methods{});
  return entries;
}

std::vector<std::string> method_names() {
  return names_of(Methods{});
}

const MethodEntry& method_named(std::string_view name, std::string_view key) {
  const auto found = std::find_if(methods().begin(), methods().end(),
                                  [&](const MethodEntry& entry) { return entry.name == name; });
  if (found == methods().end()) {
    throw InputError(fmt::format("{}: '{}' is not known; {}; `sandglass methods` lists all", key, name,
                                 suggestion(name, method_names())));
  }
  return *found;
}

}  // namespace sandglass
