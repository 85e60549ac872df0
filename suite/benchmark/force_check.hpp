#pragma once

#include <string>

#include "assembly/internal_force.hpp"
#include "mesh/mesh.hpp"

namespace sandglass {

/// max |f - reference| / max |reference| over the nodes; infinite if a force is not finite.
double relative_difference(const NodalField& f, const NodalField& reference);

/// The limit of that difference: what rounding alone can cause. A relative error eps of the volume change,
/// times the bulk modulus, is an error of the pressure. If the volume hardly changes, forces are of the size
/// of the shear stress, so their relative error is eps K / mu: about 50 eps at nu = 0.49, which is 6e-6 in
/// single and 1.1e-14 in double precision. Sums of some hundred terms add a factor of a few in single
/// precision: 2e-5. In double precision the limit is 1e-12, far above rounding and far below the effect of
/// any mistake. Both grow with K / mu beyond 50.
double force_limit(Precision precision, const AnyLaw& law);

/// "ok", or "wrong result: ..." with difference and limit.
std::string force_status(double difference, double limit);

}  // namespace sandglass
