#pragma once

#include <map>
#include <string>
#include <vector>

#include "base/type_list.hpp"
#include "material/called_law.hpp"
#include "material/elastic_laws.hpp"
#include "material/small_strain.hpp"
#include "material/viscoelastic.hpp"

namespace sandglass {

/// All laws that a case may name.
using Laws = Concatenated<ElasticLaws, Wrapped<Viscoelastic, ElasticLaws>>;

/// A law chosen at run time.
using AnyLaw = VariantOf<Laws>;

/// The laws for which kernels are compiled: the neo-Hookean one, and the others behind calls.
using KernelLaw = std::variant<NeoHookean, CalledLaw, Viscoelastic<CalledLaw>>;

/// The law as kernels take it, with its own volumetric part or another.
KernelLaw kernel_law(const AnyLaw& law, VolumetricPart volume = {});

/// The elastic law, or the instantaneous response of a viscoelastic one, behind calls.
CalledLaw elastic_law(const KernelLaw& law);

/// Whether a law has a memory.
inline bool is_viscoelastic(const AnyLaw& law) {
  return std::holds_alternative<Viscoelastic<CalledLaw>>(kernel_law(law));
}

/// Whether a law chosen at run time has its own directions.
inline bool has_fibres(const AnyLaw& any_law) {
  return std::visit([]<class Law>(const Law&) { return !is_isotropic<Law>; }, any_law);
}

/// Whether its energy is a function of J^(-1/3) F plus one of J.
inline bool splits_volume(const AnyLaw& any_law) {
  return std::visit([]<class Law>(const Law&) { return Law::traits.splits_volume; }, any_law);
}

/// The name of a law chosen at run time.
inline std::string_view name_of(const AnyLaw& any_law) {
  return std::visit([]<class Law>(const Law&) { return Law::name; }, any_law);
}

/// Calls visit(parameter, value) for each parameter of a law chosen at run time, as it is declared.
template <class Visit>
void for_each_parameter(AnyLaw& any_law, const Visit& visit) {
  std::visit(
      [&]<class Law>(Law& law) {
        std::apply([&](const auto&... p) { (visit(p, law.*p.member), ...); }, Law::parameters());
      },
      any_law);
}

/// The names of the parameters of a law, in their order.
std::vector<std::string_view> parameter_names(const AnyLaw& law);

/// Throws InputError, which begins with `where`, unless a law has a parameter of this name.
void require_parameter(const AnyLaw& law, std::string_view name, std::string_view where);

/// The law with other values of some parameters, by their names. Throws InputError, which begins with
/// `where`, for unknown names, values out of range and broken rules.
AnyLaw with_parameters(AnyLaw law, const std::map<std::string, double>& values, std::string_view where);

/// Lame's first parameter of the undeformed state, lambda = K - 2/3 mu, in Pa.
template <class Law>
constexpr double lame_lambda(const Law& law) {
  return law.bulk_modulus() - 2.0 / 3.0 * law.shear_modulus();
}

/// Young's modulus of the undeformed state, in Pa.
template <class Law>
constexpr double young_modulus(const Law& law) {
  const double mu = law.shear_modulus(), lambda = lame_lambda(law);
  return mu * (3.0 * lambda + 2.0 * mu) / (lambda + mu);
}

}  // namespace sandglass
