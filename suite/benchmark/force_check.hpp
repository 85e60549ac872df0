#pragma once

#include <string>

#include "assembly/internal_force.hpp"
#include "mesh/mesh.hpp"

namespace sandglass {

/// max |f - reference| / max |reference| over the nodes; infinite when a force is not finite.
double relative_difference(const NodalField& f, const NodalField& reference);

/// What rounding alone may do to that difference. A relative error eps of the volume change enters the
/// pressure times the bulk modulus. Where the volume hardly changes, forces are of the size of the shear
/// stress and so carry eps K / mu: about 50 eps at nu = 0.49, which is 6e-6 in single and 1.1e-14 in double
/// precision. Sums of some hundred terms leave a factor of a few in single precision: 2e-5. In double
/// precision 1e-12 is asked, far above rounding and far below what any mistake does. Both grow with K / mu
/// beyond 50.
double force_limit(Precision precision, const AnyLaw& law);

/// "ok", or "wrong result: ..." with difference and limit.
std::string force_status(double difference, double limit);

}  // namespace sandglass
