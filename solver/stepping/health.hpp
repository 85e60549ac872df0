#pragma once

#include <string_view>

#include "model/model.hpp"

namespace sandglass {

/// Throws ComputationError when a displacement is not finite or an element is inverted at u; names the step,
/// the first ten elements with det F, and a remedy.
void require_healthy(const Model& model, const NodalField& u, long step);

}  // namespace sandglass
