#pragma once

#include "base/type_list.hpp"
#include "material/fibre_neo_hookean.hpp"
#include "material/mooney_rivlin.hpp"
#include "material/neo_hookean.hpp"
#include "material/ogden.hpp"
#include "material/st_venant_kirchhoff.hpp"
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

}  // namespace sandglass
