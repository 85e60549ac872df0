#pragma once

#include "solve/relaxation.hpp"

namespace sandglass {

/// The static answer of a condensed method: the response of the driven sets times their displacements. One
/// evaluation of the forces tells its residual. Throws as CondensedResponse does, and ComputationError when
/// an element is inverted.
Relaxation condensed_answer(const Model& model, Observer& observer);

}  // namespace sandglass
