#pragma once

#include "base/type_list.hpp"
#include "material/compressible_neo_hookean.hpp"
#include "material/fibre_neo_hookean.hpp"
#include "material/guccione.hpp"
#include "material/holzapfel_ogden.hpp"
#include "material/mooney_rivlin.hpp"
#include "material/neo_hookean.hpp"
#include "material/ogden.hpp"
#include "material/st_venant_kirchhoff.hpp"
#include "material/yeoh.hpp"

namespace sandglass {

/// The list of material laws. A new law is one header and one entry here; it is available in two forms,
/// elastic and viscoelastic. `Value` is the type of its parameters: double, or a pack with the numbers of as
/// many bodies.
///
/// Each law has name, summary, traits, parameters(), the initial shear_modulus() and bulk_modulus(), and,
/// templated on the number type, isochoric_energy, volumetric_energy, pressure, bulk_tangent,
/// isochoric_piola, energy, piola, isochoric_tangent_bound, and for the kernels weighted_piola and
/// weighted_kirchhoff. QuadraticVolume provides the common parts. A law that is not isotropic also has
/// small_strain_stress; a law with rules between its parameters has broken_rule.
template <class Value>
using ElasticLawsOf = TypeList<NeoHookeanOf<Value>, StVenantKirchhoffOf<Value>, MooneyRivlinOf<Value>,
                               YeohOf<Value>, OgdenOf<Value>, FibreNeoHookeanOf<Value>, GuccioneOf<Value>,
                               HolzapfelOgdenOf<Value>, CompressibleNeoHookeanOf<Value>>;
using ElasticLaws = ElasticLawsOf<double>;

}  // namespace sandglass
