#pragma once

#include "solve/relaxation.hpp"

namespace sandglass {

/// The static answer of a condensed method: the response of the driven sets times their displacements. Its
/// residual is computed by one evaluation of the forces. Throws as CondensedResponse, and ComputationError if
/// an element is inverted.
Relaxation condensed_answer(const Model& model, Observer& observer);

}  // namespace sandglass
