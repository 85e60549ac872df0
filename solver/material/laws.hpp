#pragma once

#include "base/type_list.hpp"
#include "material/any_elastic_law.hpp"
#include "material/fibre_neo_hookean.hpp"
#include "material/mooney_rivlin.hpp"
#include "material/neo_hookean.hpp"
#include "material/ogden.hpp"
#include "material/st_venant_kirchhoff.hpp"
#include "material/viscoelastic.hpp"
#include "material/yeoh.hpp"

namespace sandglass {

/// THE list of material laws. A new law is one header and one entry here; it comes in two forms, as it is and
/// viscoelastic.
/// Each gives: name, summary, parameters(), shear_modulus(), bulk_modulus() at rest, and templated on the
/// number type isochoric_energy, volumetric_energy, pressure, bulk_tangent, isochoric_piola, energy, piola,
/// isochoric_tangent_bound; and what the kernels run, weighted_piola and weighted_kirchhoff. QuadraticVolume
/// holds what they have in common. A law that is not isotropic gives small_strain_stress; one with rules
/// between its parameters broken_rule.
using ElasticLaws = TypeList<NeoHookean, StVenantKirchhoff, MooneyRivlin, Yeoh, Ogden, FibreNeoHookean>;

/// All laws that a case may name.
using Laws = Concatenated<ElasticLaws, Wrapped<Viscoelastic, ElasticLaws>>;

/// The law that the kernels run: an elastic law itself; of viscoelastic laws one for all, so that the kernels
/// are not compiled anew for each.
template <class Law>
const Law& kernel_law(const Law& law) {
  return law;
}
template <class Law>
auto kernel_law(const Viscoelastic<Law>& law) {
  using Elastic = AnyElasticLaw<ElasticLaws>;
  return Viscoelastic<Elastic>{Elastic(static_cast<const Law&>(law)), law.relaxation_1, law.time_1,
                               law.relaxation_2, law.time_2};
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
