#pragma once

#include "base/type_list.hpp"
#include "material/called_law.hpp"
#include "material/elastic_laws.hpp"
#include "material/viscoelastic.hpp"

namespace sandglass {

/// All laws that a case may name.
using Laws = Concatenated<ElasticLaws, Wrapped<Viscoelastic, ElasticLaws>>;

/// The law that kernels are compiled for: the neo-Hookean one itself, the others behind calls.
inline const NeoHookean& kernel_law(const NeoHookean& law) {
  return law;
}
template <class Law>
CalledLaw kernel_law(const Law& law) {
  return CalledLaw(law);
}
template <class Law>
Viscoelastic<CalledLaw> kernel_law(const Viscoelastic<Law>& law) {
  return {CalledLaw(static_cast<const Law&>(law)), law.relaxation_1, law.time_1, law.relaxation_2,
          law.time_2};
}

/// A law chosen at run time.
using AnyLaw = VariantOf<Laws>;

/// The name of a law chosen at run time.
inline std::string_view name_of(const AnyLaw& any_law) {
  return std::visit([]<class Law>(const Law&) { return Law::name; }, any_law);
}

/// Lame's first parameter at rest, lambda = K - 2/3 mu, in Pa.
template <class Law>
constexpr double lame_lambda(const Law& law) {
  return law.bulk_modulus() - 2.0 / 3.0 * law.shear_modulus();
}

/// Young's modulus at rest, in Pa.
template <class Law>
constexpr double young_modulus(const Law& law) {
  const double mu = law.shear_modulus(), lambda = lame_lambda(law);
  return mu * (3.0 * lambda + 2.0 * mu) / (lambda + mu);
}

}  // namespace sandglass
